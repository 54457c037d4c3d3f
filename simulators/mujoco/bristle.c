/* Friction that holds without creep.
 *
 * The bristle of Dupont, Hayward, Armstrong and Altpeter (IEEE Trans. Automat. Contr. 47, 2002) whose break-away is Coulomb's limit:
 * below it the deflection s is elastic, so that a load that stays has a position that stays; at the limit s follows the motion. (LuGre's
 * bristle creeps at any load.)
 *
 *   f = -(k s + c v),  s' = v,  but |k s| <= mu F
 *
 * with the moment about the normal by the same bristle at the radius torsion/mu, and the limit surface of a soft finger (Howe and
 * Cutkosky, Int. J. Robot. Res. 15, 1996): (T/(mu F))^2 + (M/(torsion F))^2 <= 1. */
#include <math.h>

#include "plugin.h"

/* The deflection of the start turned with the jaw into the world and across the present normal, as long as it was. */
static void carried_along(const mjtNum jaw_frame[9], const mjtNum normal[3], const mjtNum* memory, mjtNum slip[3]) {
  const mjtNum length = mju_norm3(memory + MEMORY_SLIP);
  mjtNum across;
  mju_mulMatVec3(slip, jaw_frame, memory + MEMORY_SLIP);
  mju_addToScl3(slip, normal, -mju_dot3(slip, normal));
  across = mju_norm3(slip);
  if (across > 0) mju_scl3(slip, slip, length / across);
}

/* The engine's inverse weight is the mean over three axes: that of a free body, and a third of it for one that moves along one axis alone. */
static double mobility_of_body(const mjModel* m, const contact* c, int geom, double arm) {
  const mjtNum* inverse = m->body_invweight0 + 2 * m->geom_bodyid[geom];
  const double radius = c->friction > 0 ? c->torsion / c->friction : 0;
  return inverse[0] + (arm * arm + radius * radius) * inverse[1];
}

double mobility_of(const mjModel* m, const contact* c, double arm1, double arm2) {
  return mobility_of_body(m, c, c->geom1, arm1) + mobility_of_body(m, c, c->geom2, arm2);
}

/* A step v += -h (k s + c v) w, s += h v of a body of the mobility w settles while 2 h c w + h^2 k w < 4; Runge's and Kutta's while the
 * roots of x^2 + c w x + k w = 0 are within 2.6/h, a half circle that its region of stability contains. The fastest motion of a body with
 * several contacts is at most as fast as all of them together make one. */
double longest_step(const mjModel* m, const mjData* d, const contact* c, const mjtNum point[3]) {
  const double arm1 = mju_dist3(point, d->xipos + 3 * m->geom_bodyid[c->geom1]);
  const double arm2 = mju_dist3(point, d->xipos + 3 * m->geom_bodyid[c->geom2]);
  const double mobility = c->neighbours * mobility_of(m, c, arm1, arm2);
  const double rate = c->tangential_damping * mobility, square = c->tangential_stiffness * mobility;
  if (m->opt.integrator != mjINT_RK4) return 4 / (rate + sqrt(rate * rate + 4 * square));
  return 2.6 / (rate * rate > 4 * square ? 0.5 * (rate + sqrt(rate * rate - 4 * square)) : sqrt(square));
}

void let_go(mjtNum* memory) {
  mju_zero3(memory + MEMORY_SLIP);
  memory[MEMORY_TWIST] = 0;
}

traction bristle(const contact* c, const placement* at, const mjtNum jaw_frame[9], double normal_force, mjtNum* memory) {
  traction friction = {{0, 0, 0}, 0, 0, c->friction * normal_force};
  const double radius = c->friction > 0 ? c->torsion / c->friction : 0;
  mjtNum slip[3], twist, elastic;
  if (!(friction.limit > 0)) {
    let_go(memory);
    friction.limit = 0;
    return friction;
  }
  carried_along(jaw_frame, at->normal, memory, slip);
  mju_addTo3(slip, at->path);
  twist = memory[MEMORY_TWIST] + at->turn;
  elastic = c->tangential_stiffness * hypot(mju_norm3(slip), radius * twist);
  if (elastic > friction.limit) {
    mju_scl3(slip, slip, friction.limit / elastic);
    twist *= friction.limit / elastic;
  }
  mju_mulMatTVec3(memory + MEMORY_SLIP, jaw_frame, slip);
  memory[MEMORY_TWIST] = twist;
  mju_scl3(friction.force, slip, -c->tangential_stiffness);
  mju_addToScl3(friction.force, at->velocity, -c->tangential_damping);
  friction.moment = -radius * radius * (c->tangential_stiffness * twist + c->tangential_damping * at->spin);
  friction.load = hypot(mju_norm3(friction.force), radius > 0 ? friction.moment / radius : 0);
  if (friction.load > friction.limit) {
    mju_scl3(friction.force, friction.force, friction.limit / friction.load);
    friction.moment *= friction.limit / friction.load;
    friction.load = friction.limit;
  }
  return friction;
}
