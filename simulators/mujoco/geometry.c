/* Displacement, normal and relative motion at a contact of two geoms. */
#include <math.h>

#include "plugin.h"

/* Jacobian of a point on a body: of its velocity, then of its rotation. */
static void jacobian_of(const mjModel* m, const mjData* d, int geom, const mjtNum point[3], mjtNum* jacobian) {
  const int body = m->geom_bodyid[geom], nv = m->nv;
  if (m->body_weldid[body] == 0) {
    mju_zero(jacobian, 6 * nv);
  } else {
    mj_jac(m, d, jacobian, jacobian + 3 * nv, point, body);
  }
}

/* Jacobian of the body relative to the jaw at the point, and the motion that it gives. */
static void relative_motion(const mjModel* m, const mjData* d, const contact* c, placement* at) {
  const int nv = m->nv;
  const mjtNum* rotation = c->jacobian + 3 * nv;
  mjtNum spin[3], along;
  jacobian_of(m, d, c->geom2, at->point, c->jacobian);
  jacobian_of(m, d, c->geom1, at->point, c->other);
  mju_subFrom(c->jacobian, c->other, 6 * nv);
  mju_mulMatVec(at->velocity, c->jacobian, d->qvel, 3, nv);
  mju_mulMatVec(spin, rotation, d->qvel, 3, nv);
  along = mju_dot3(at->velocity, at->normal);
  mju_addToScl3(at->velocity, at->normal, -along);
  at->closing = -along;
  at->spin = mju_dot3(spin, at->normal);
}

/* Distance of two geoms (m) and the segment between them. The search goes far only where it finds nothing within the depth of the body. */
static mjtNum distance_of(const mjModel* m, mjData* d, const contact* c, mjtNum ends[6]) {
  const mjtNum near = mj_geomDistance(m, d, c->geom1, c->geom2, c->depth, ends);
  return near < c->depth ? near : mj_geomDistance(m, d, c->geom1, c->geom2, mjMAXVAL, ends);
}

void place_geoms(const mjModel* m, mjData* d, contact* c, placement* at) {
  mjtNum ends[6];
  const mjtNum distance = distance_of(m, d, c, ends);
  /* On the rigid one of the two, which is geom1; no body is a plane. */
  const mjtNum* on_rigid = m->geom_type[c->geom2] == mjGEOM_PLANE ? ends + 3 : ends;
  at->displacement = -distance;
  at->spin = at->closing = 0;
  mju_copy3(at->point, on_rigid);
  mju_zero3(at->velocity);
  mju_sub3(at->normal, ends + 3, ends);
  if (mju_normalize3(at->normal) < mjMINVAL || distance == 0) {
    /* No segment at first touch, where there is no force yet. */
    mju_sub3(at->normal, d->geom_xpos + 3 * c->geom2, d->geom_xpos + 3 * c->geom1);
    mju_normalize3(at->normal);
  } else if (distance < 0) {
    mju_scl3(at->normal, at->normal, -1);
  }
  /* Beyond reach there is no force, and nothing is needed of the motion. */
  if (distance < c->depth) relative_motion(m, d, c, at);
}

/* From positions, not from speeds by time, so that the deflection of friction is the same whichever way the engine integrates: what is
 * held does not creep. All is made of differences of the poses: what has not moved has moved by 0 to the last bit. */
void follow(const mjData* d, const contact* c, int has_begun, mjtNum* memory, placement* at) {
  const mjtNum *frame1 = d->geom_xmat + 9 * c->geom1, *frame2 = d->geom_xmat + 9 * c->geom2;
  mjtNum offset[3], place[3], turn[9], arm[3], turned[9], path[3], across[9], spin[3];
  mju_sub3(offset, d->geom_xpos + 3 * c->geom2, d->geom_xpos + 3 * c->geom1);
  mju_mulMatTVec3(place, frame1, offset);
  mju_mulMatTMat(turn, frame1, frame2, 3, 3, 3);
  mju_zero3(at->path);
  at->turn = 0;
  if (has_begun) {
    /* That point of the body which is at the contact now. */
    mju_sub3(offset, at->point, d->geom_xpos + 3 * c->geom2);
    mju_mulMatTVec3(arm, frame2, offset);
    mju_sub(turned, turn, memory + MEMORY_TURN, 9);
    mju_mulMatVec3(path, turned, arm);
    mju_addTo3(path, place);
    mju_subFrom3(path, memory + MEMORY_PLACE);
    mju_mulMatVec3(at->path, frame1, path);
    mju_addToScl3(at->path, at->normal, -mju_dot3(at->path, at->normal));
    mju_mulMatMatT(across, turned, memory + MEMORY_TURN, 3, 3, 3);
    spin[0] = 0.5 * (across[7] - across[5]);
    spin[1] = 0.5 * (across[2] - across[6]);
    spin[2] = 0.5 * (across[3] - across[1]);
    mju_mulMatVec3(arm, frame1, spin);
    at->turn = mju_dot3(arm, at->normal);
  }
  mju_copy3(memory + MEMORY_PLACE, place);
  mju_copy(memory + MEMORY_TURN, turn, 9);
}

void apply(const mjModel* m, const contact* c, const placement* at, double normal_force, const traction* friction, mjtNum* qfrc) {
  const int nv = m->nv;
  mjtNum force[3], moment[3];
  int row, column;
  mju_scl3(force, at->normal, normal_force);
  mju_addTo3(force, friction->force);
  mju_scl3(moment, at->normal, friction->moment);
  for (row = 0; row < 3; row++) {
    const mjtNum *translation = c->jacobian + row * nv, *rotation = c->jacobian + (3 + row) * nv;
    for (column = 0; column < nv; column++) {
      qfrc[column] += force[row] * translation[column] + moment[row] * rotation[column];
    }
  }
}
