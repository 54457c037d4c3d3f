/* Configuration of a contact, from its keys in MJCF. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plugin.h"

static const char* name_of(const mjModel* m, int instance) {
  const char* name = mj_id2name(m, mjOBJ_PLUGIN, instance);
  return name ? name : "without a name";
}

static const char* text_of(const mjModel* m, int instance, const char* key) {
  const char* text = mj_getPluginConfig(m, instance, key);
  return text && text[0] ? text : NULL;
}

static double number_of(const mjModel* m, int instance, const char* key, double otherwise, double least) {
  const char* text = text_of(m, instance, key);
  char* end = NULL;
  double number = otherwise;
  if (text) {
    number = strtod(text, &end);
    while (*end == ' ') end++;
    if (end == text || *end || !isfinite(number) || number < least) {
      mju_error("%s \"%s\": %s: expected a number of %g or more, found \"%s\"", CONTACT_PLUGIN, name_of(m, instance), key,
                least, text);
    }
  }
  return number;
}

static int object_of(const mjModel* m, int instance, const char* key, int type, const char* kind) {
  const char* text = text_of(m, instance, key);
  int id = text ? mj_name2id(m, type, text) : -1;
  if (text && id < 0) {
    mju_error("%s \"%s\": %s: expected the name of a %s, found \"%s\"", CONTACT_PLUGIN, name_of(m, instance), key, kind, text);
  }
  return id;
}

/* Refuses keys that a contact of the other kind has. */
static void refuse_keys(const mjModel* m, int instance, const char* const* keys, const char* other) {
  for (; *keys; keys++) {
    if (text_of(m, instance, *keys)) {
      mju_error("%s \"%s\": %s: expected none with %s", CONTACT_PLUGIN, name_of(m, instance), *keys, other);
    }
  }
}

/* Refuses a body that the engine may put to sleep: nothing wakes it when a contact presses it that the engine does not know of. */
static void refuse_sleep(const mjModel* m, int instance, int body) {
#ifdef mjMINAWAKE
  const int tree = m->body_treeid[body];
  const int policy = tree < 0 ? mjSLEEP_NEVER : m->tree_sleep_policy[tree];
  const char* name = mj_id2name(m, mjOBJ_BODY, m->body_rootid[body]);
  if ((m->opt.enableflags & mjENBL_SLEEP) && policy != mjSLEEP_NEVER && policy != mjSLEEP_AUTO_NEVER) {
    mju_error("%s \"%s\": the body \"%s\" may fall asleep, and this contact does not wake it: set sleep=\"never\" on it", CONTACT_PLUGIN,
              name_of(m, instance), name ? name : "without a name");
  }
#else
  (void)m;
  (void)instance;
  (void)body;
#endif
}

static void read_model(const mjModel* m, int instance, contact* c) {
  const char* path = text_of(m, instance, "material");
  const char* text = text_of(m, instance, "description");
  char message[600] = "";
  palpate_status status;
  int32_t sides = 1;
  if (!path == !text) {
    mju_error("%s \"%s\": expected one of the keys material (a file) and description (its text), found %s", CONTACT_PLUGIN,
              name_of(m, instance), path ? "both" : "none");
  }
  status = path ? palpate_model_from_file(path, &c->model, message, sizeof message)
                : palpate_model_from_text(text, "description", &c->model, message, sizeof message);
  if (status != PALPATE_STATUS_OK) {
    mju_error("%s \"%s\": %s", CONTACT_PLUGIN, name_of(m, instance), message[0] ? message : palpate_status_text(status));
  }
  palpate_model_sides(c->model, &sides);
  palpate_model_depth_m(c->model, &c->depth);
  palpate_model_deepest_m(c->model, &c->deepest);
  palpate_model_calibrated_m(c->model, &c->calibrated);
  c->sides = sides;
}

/* A body that counts as bonded pulls from any distance, so it is allowed only at a joint that starts at first touch or beyond, and never
 * between geoms, whose friction, none in tension, is no bond either. */
static void refuse_bond(const mjModel* m, int instance, const contact* c) {
  static const char* const hint = "hint: set separation = true under [contact] of the test description where the jaw only presses, and calibrate again";
  int32_t is_bonded = 0;
  palpate_model_is_bonded(c->model, &is_bonded);
  if (!is_bonded) return;
  if (c->joint < 0) {
    mju_error("%s \"%s\": separation = false in the description: a bonded body would pull a geom from any distance; %s", CONTACT_PLUGIN,
              name_of(m, instance), hint);
  } else {
    const double ahead = c->closing * (c->touch - m->qpos0[m->jnt_qposadr[c->joint]]);
    if (ahead > 0) {
      mju_error("%s \"%s\": separation = false in the description: a bonded body would pull the joint, which starts %g m before first touch; %s",
                CONTACT_PLUGIN, name_of(m, instance), ahead, hint);
    }
  }
}

static void read_joint(const mjModel* m, int instance, contact* c) {
  static const char* const others[] = {"friction", "torsional_friction", "tangential_stiffness", "tangential_damping", NULL};
  refuse_keys(m, instance, others, "a joint");
  refuse_sleep(m, instance, m->jnt_bodyid[c->joint]);
  if (m->jnt_type[c->joint] != mjJNT_SLIDE) {
    mju_error("%s \"%s\": joint: expected a slide joint, found another", CONTACT_PLUGIN, name_of(m, instance));
  }
  c->closing = number_of(m, instance, "closing", 1, -1);
  if (fabs(c->closing) != 1) {
    mju_error("%s \"%s\": closing: expected 1 or -1, found %g", CONTACT_PLUGIN, name_of(m, instance), c->closing);
  }
  c->touch = number_of(m, instance, "touch", 0, -mjMAXVAL);
}

/* Whether the engine computes a contact of its own between two geoms. */
static int collide(const mjModel* m, int geom1, int geom2) {
  int body1 = m->geom_bodyid[geom1], body2 = m->geom_bodyid[geom2], i;
  int low = mjMIN(body1, body2), high = mjMAX(body1, body2);
  for (i = 0; i < m->npair; i++) {
    int a = m->pair_geom1[i], b = m->pair_geom2[i];
    if ((a == geom1 && b == geom2) || (a == geom2 && b == geom1)) return 1;
  }
  for (i = 0; i < m->nexclude; i++) {
    if (m->exclude_signature[i] == ((low << 16) + high)) return 0;
  }
  return (m->geom_contype[geom1] & m->geom_conaffinity[geom2]) || (m->geom_contype[geom2] & m->geom_conaffinity[geom1]);
}

/* Two thirds of the stiffness that the body has once it is squeezed by a tenth of its depth at once: Mindlin's ratio of tangential to
 * normal stiffness, 2 (1 - nu)/(2 - nu), of an incompressible body. Constant, so that a load that stays has a deflection that stays. */
static double own_tangential_stiffness(const contact* c) {
  palpate_state state = {0, 0};
  double stiffness = 0, place = fmin(0.1 * c->depth * c->sides, 0.5 * c->deepest);
  palpate_step(c->model, &state, 0, place, NULL);
  palpate_stiffness(c->model, &state, &stiffness);
  return 2.0 / 3.0 * c->sides * stiffness;
}

/* Distance of the farthest point of a geom from the centre of mass of its body, m. */
static double reach_of(const mjModel* m, int geom) {
  return mju_dist3(m->geom_pos + 3 * geom, m->body_ipos + 3 * m->geom_bodyid[geom]) + m->geom_rbound[geom];
}

/* Half of critical damping of what the bristle moves: the two bodies, which rotate too. */
static double own_tangential_damping(const mjModel* m, const contact* c) {
  const double mobility = mobility_of(m, c, reach_of(m, c->geom1), reach_of(m, c->geom2));
  return mobility > 0 ? sqrt(c->tangential_stiffness / mobility) : 0;
}

/* Number of contacts of this plug-in between geoms that move the same body as a geom; none of a body that does not move. */
static int contacts_of_body(const mjModel* m, int instance, int geom) {
  static const char* const keys[] = {"geom1", "geom2"};
  const int body = m->body_weldid[m->geom_bodyid[geom]];
  int other, key, count = 0;
  for (other = 0; body && other < m->nplugin; other++) {
    for (key = 0; m->plugin[other] == m->plugin[instance] && key < 2; key++) {
      const char* name = text_of(m, other, keys[key]);
      const int found = name ? mj_name2id(m, mjOBJ_GEOM, name) : -1;
      count += found >= 0 && m->body_weldid[m->geom_bodyid[found]] == body;
    }
  }
  return count;
}

static void read_geoms(const mjModel* m, int instance, contact* c) {
  static const char* const others[] = {"closing", "touch", NULL};
  const mjtNum *friction1, *friction2;
  refuse_keys(m, instance, others, "geoms");
  refuse_sleep(m, instance, m->geom_bodyid[c->geom1]);
  refuse_sleep(m, instance, m->geom_bodyid[c->geom2]);
  if (m->geom_bodyid[c->geom1] == m->geom_bodyid[c->geom2]) {
    mju_error("%s \"%s\": expected geoms of two bodies, found two of one", CONTACT_PLUGIN, name_of(m, instance));
  }
  friction1 = m->geom_friction + 3 * c->geom1;
  friction2 = m->geom_friction + 3 * c->geom2;
  c->friction = number_of(m, instance, "friction", fmax(friction1[0], friction2[0]), 0);
  c->torsion = number_of(m, instance, "torsional_friction", fmax(friction1[1], friction2[1]), 0);
  c->tangential_stiffness = number_of(m, instance, "tangential_stiffness", own_tangential_stiffness(c), 0);
  c->tangential_damping = number_of(m, instance, "tangential_damping", own_tangential_damping(m, c), 0);
  c->neighbours = mjMAX(contacts_of_body(m, instance, c->geom1), contacts_of_body(m, instance, c->geom2));
  if (collide(m, c->geom1, c->geom2)) {
    mju_warning("%s \"%s\": MuJoCo computes a contact between the same geoms: add <exclude body1=... body2=...> to <contact>",
                CONTACT_PLUGIN, name_of(m, instance));
  }
}

contact* contact_of(const mjModel* m, int instance) {
  contact* c = (contact*)calloc(1, sizeof *c);
  double substeps;
  if (!c) mju_error("%s: out of memory", CONTACT_PLUGIN);
  c->geom1 = object_of(m, instance, "geom1", mjOBJ_GEOM, "geom");
  c->geom2 = object_of(m, instance, "geom2", mjOBJ_GEOM, "geom");
  c->joint = object_of(m, instance, "joint", mjOBJ_JOINT, "joint");
  if (!((c->geom1 >= 0 && c->geom2 >= 0 && c->joint < 0) || (c->joint >= 0 && c->geom1 < 0 && c->geom2 < 0))) {
    mju_error("%s \"%s\": expected the keys geom1 and geom2, or the key joint", CONTACT_PLUGIN, name_of(m, instance));
  }
  read_model(m, instance, c);
  substeps = number_of(m, instance, "substeps", 1, 1);
  if (substeps != floor(substeps) || substeps > 1000) {
    mju_error("%s \"%s\": substeps: expected a whole number of 1 to 1000, found %g", CONTACT_PLUGIN, name_of(m, instance), substeps);
  }
  c->substeps = (int)substeps;
  c->normal_damping = number_of(m, instance, "normal_damping", 0, 0);
  if (c->joint >= 0) {
    read_joint(m, instance, c);
  } else {
    read_geoms(m, instance, c);
  }
  refuse_bond(m, instance, c);
  c->jacobian = (mjtNum*)calloc(12 * (size_t)mjMAX(1, m->nv), sizeof(mjtNum));
  if (!c->jacobian) mju_error("%s: out of memory", CONTACT_PLUGIN);
  c->other = c->jacobian + 6 * m->nv;
  return c;
}

void contact_free(contact* c) {
  if (!c) return;
  palpate_model_free(c->model);
  free(c->jacobian);
  free(c);
}
