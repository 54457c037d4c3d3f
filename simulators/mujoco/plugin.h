/* The engine plug-ins palpate.contact and palpate.sensor of MuJoCo: what their files share.
 *
 * | file | content |
 * |---|---|
 * | options.c | configuration of a contact, from its keys in MJCF |
 * | geometry.c | displacement, normal and relative motion at a contact |
 * | bristle.c | friction that holds without creep |
 * | contact.c | palpate.contact: the passive force of a soft contact with memory |
 * | sensor.c | palpate.sensor: what such a contact measures |
 * | build.py | builds the library for one version of MuJoCo |
 *
 * docs/guides/simulators-mujoco.md explains their use. */
#ifndef PALPATE_MUJOCO_PLUGIN_H
#define PALPATE_MUJOCO_PLUGIN_H

#include <mujoco/mujoco.h>

#include "palpate.h"

#define CONTACT_PLUGIN "palpate.contact"
#define SENSOR_PLUGIN "palpate.sensor"

/* The memory of a contact at an instant, as numbers of mjData.plugin_state. */
typedef enum {
  MEMORY_BEGUN,  /* 1 once the contact has been computed, 0 of a body that nothing has touched */
  MEMORY_TIME,   /* the instant, s */
  MEMORY_JAW,    /* palpate_state.jaw_m */
  MEMORY_BEHIND, /* palpate_state.behind_m */
  MEMORY_SLIP,   /* deflection of the bristle in the frame of geom1, m: three numbers */
  MEMORY_TWIST = MEMORY_SLIP + 3, /* its twist about the normal, rad */
  MEMORY_PLACE,                   /* centre of geom2 in the frame of geom1, m: three numbers */
  MEMORY_TURN = MEMORY_PLACE + 3, /* rotation from the frame of geom2 to that of geom1: nine numbers */
  MEMORY_COUNT = MEMORY_TURN + 9
} memory_index;

/* What a contact measures at the latest computed instant; the sensor copies it. */
typedef enum {
  MEASURE_EXCESS_STRAIN,   /* strain of the contact layer in excess of equilibrium */
  MEASURE_NORMAL_FORCE,    /* N */
  MEASURE_MARGIN_TO_SLIP,  /* friction limit less load, N; 0 while it slips or the jaw is off */
  MEASURE_TANGENTIAL_LOAD, /* tangential force and torsion as the force that loads the contact as much, N */
  MEASURE_DISPLACEMENT,    /* displacement of one contact since first touch, m; the distance below 0 while it is off */
  MEASURE_COUNT
} measure_index;

/* The numbers of one instance in mjData.plugin_state. A step begins at `START`; every evaluation of forces computes `NOW` from it, and the
 * engine's advance makes it the start of the next step. So an evaluation can be repeated, and all of it is in mjData. */
enum {
  STATE_START = 0,
  STATE_NOW = MEMORY_COUNT,
  STATE_IS_AHEAD = 2 * MEMORY_COUNT, /* 1 from an evaluation to the next advance */
  STATE_MEASURES,
  STATE_COUNT = STATE_MEASURES + MEASURE_COUNT
};

/* What has been reported of an instance since its last reset: each finding once. */
typedef enum { FINDING_BEYOND_BODY, FINDING_BEYOND_CALIBRATION, FINDING_NOT_FINITE, FINDING_COUNT } finding;

/* One contact: its options, and memory to compute in. It belongs to one mjData. */
typedef struct {
  palpate_model* model;
  double sides;      /* 2 where each contact takes half the displacement of the jaws */
  double depth;      /* m */
  double deepest;    /* largest displacement of the jaw that the body takes, m */
  double calibrated; /* that of its calibration, m */
  int geom1, geom2;  /* the rigid one and the soft one, or -1 */
  int joint;         /* or a slide joint, or -1 */
  double closing;    /* +1 or -1: direction of the joint that squeezes */
  double touch;      /* position of the joint at first touch, m */
  double friction;   /* Coulomb's coefficient */
  double torsion;    /* torsional friction: largest moment about the normal over the normal force, m */
  double normal_damping;       /* N s/m, beside that of the material; 0 unless requested */
  double tangential_stiffness; /* N/m */
  double tangential_damping;   /* N s/m */
  int neighbours;    /* contacts that move the same body, this one included: the larger number of the two bodies */
  int is_step_known; /* whether the time step was compared with that at which friction settles */
  int substeps;
  mjtNum* jacobian; /* (3 + 3) x nv: of the velocity and the rotation of the body relative to the jaw */
  mjtNum* other;    /* the same of one body */
  int reported[FINDING_COUNT];
} contact;

/* Where a contact is and how it moves, in the world. */
typedef struct {
  double displacement; /* of one contact since first touch, m; below 0 while the jaw is off */
  mjtNum point[3];     /* on the rigid one of the two */
  mjtNum normal[3];    /* from the jaw into the body */
  mjtNum velocity[3];  /* of the body relative to the jaw, across the normal, m/s */
  mjtNum closing;      /* speed at which they come together along the normal, m/s */
  mjtNum spin;         /* of the body relative to the jaw about the normal, rad/s */
  mjtNum path[3];      /* of the body relative to the jaw, across the normal, since the start of the step, m */
  mjtNum turn;         /* and about the normal, rad */
} placement;

/* Friction at an instant. */
typedef struct {
  mjtNum force[3]; /* on the body, across the normal, N */
  mjtNum moment;   /* on the body about the normal, N m */
  double load;     /* force and moment as a tangential force that loads the contact as much, N */
  double limit;    /* Coulomb's, N */
} traction;

/* Reads the options of an instance; ends by mju_error where they make no contact. */
contact* contact_of(const mjModel* m, int instance);
void contact_free(contact* c);

/* Where the contact of two geoms is. */
void place_geoms(const mjModel* m, mjData* d, contact* c, placement* at);

/* How far the body has moved relative to the jaw since the poses of `memory`, which become the present ones; not at all if nothing moved
 * before. */
void follow(const mjData* d, const contact* c, int has_begun, mjtNum* memory, placement* at);

/* Deflects the bristle of `memory` by the motion since the start of the step and returns the friction under a normal force. */
traction bristle(const contact* c, const placement* at, const mjtNum jaw_frame[9], double normal_force, mjtNum* memory);

/* What a tangential force of 1 N accelerates the contact by, m/s^2, at two distances (m) from the centres of mass: an inverse mass. */
double mobility_of(const mjModel* m, const contact* c, double arm1, double arm2);

/* Time step up to which friction is sure to settle at a contact of free bodies, s; infinite where nothing moves. */
double longest_step(const mjModel* m, const mjData* d, const contact* c, const mjtNum point[3]);

/* Takes the deflection from the bristle of `memory`: nothing deflects what is apart. */
void let_go(mjtNum* memory);

/* Adds the force and the moment on the body, and their opposites on the jaw, to generalised forces. */
void apply(const mjModel* m, const contact* c, const placement* at, double normal_force, const traction* friction, mjtNum* qfrc);

void register_contact(void);
void register_sensor(void);

#endif
