/* palpate.contact: the passive force of a soft contact with memory, between two geoms or at a slide joint. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "plugin.h"

static contact* contact_in(const mjData* d, int instance) { return (contact*)d->plugin_data[instance]; }

/* Reports a finding once after each reset. */
static void report(const mjModel* m, contact* c, int instance, finding what, double found) {
  const char* name = mj_id2name(m, mjOBJ_PLUGIN, instance);
  if (c->reported[what]) return;
  c->reported[what] = 1;
  if (!name) name = "without a name";
  switch (what) {
    case FINDING_BEYOND_BODY:
      mju_warning("%s \"%s\": displacement of %g m is beyond the %g m that the body takes; its force goes on along the last slope",
                  CONTACT_PLUGIN, name, found, c->deepest);
      break;
    case FINDING_BEYOND_CALIBRATION:
      mju_warning("%s \"%s\": displacement of %g m is beyond the %g m of its calibration", CONTACT_PLUGIN, name, found, c->calibrated);
      break;
    default:
      mju_warning("%s \"%s\": its state is not finite; it begins anew", CONTACT_PLUGIN, name);
  }
}

/* Compares the time step with that of friction, once in the life of the data, at first touch. */
static void check_step(const mjModel* m, const mjData* d, contact* c, int instance, const mjtNum point[3]) {
  const double longest = longest_step(m, d, c, point);
  const char* name = mj_id2name(m, mjOBJ_PLUGIN, instance);
  if (m->opt.timestep > longest) {
    mju_warning("%s \"%s\": friction may shake for ever: expected a time step of %.3g s or less, found %g s", CONTACT_PLUGIN,
                name ? name : "without a name", longest, m->opt.timestep);
  }
  c->is_step_known = 1;
}

/* One step of the jaw; what is bonded to it and cannot be pulled stays at first touch. */
static palpate_status step(const contact* c, palpate_state* state, double dt, double place, double* force) {
  palpate_status status = palpate_step(c->model, state, dt, place, force);
  if (status == PALPATE_STATUS_DISPLACEMENT && place < 0) status = palpate_step(c->model, state, dt, 0, force);
  return status;
}

/* Moves the jaw to the displacement `to` within dt. Returns the force; the state that results is in `memory`. A body that is
 * squeezed beyond its range has the force at its end and goes on along the last slope. */
static double squeeze(const mjModel* m, contact* c, int instance, double dt, double to, mjtNum* memory) {
  palpate_state state = {memory[MEMORY_JAW], memory[MEMORY_BEHIND]};
  const double from = c->sides * state.jaw_m, inside = fmin(to, c->deepest);
  double force = 0, slope = 0;
  int i;
  for (i = 1; i <= c->substeps; i++) {
    double place = i == c->substeps ? inside : fmin(from + (inside - from) * i / c->substeps, c->deepest);
    if (step(c, &state, dt / c->substeps, place, &force) != PALPATE_STATUS_OK) {
      report(m, c, instance, FINDING_NOT_FINITE, to);
      state.jaw_m = state.behind_m = force = 0;
      if (step(c, &state, 0, inside, &force) != PALPATE_STATUS_OK) state.jaw_m = state.behind_m = force = 0;
      break;
    }
  }
  if (to > c->deepest) {
    report(m, c, instance, FINDING_BEYOND_BODY, to);
    palpate_stiffness(c->model, &state, &slope);
    force += slope * (to - c->deepest);
  } else if (to > c->calibrated) {
    report(m, c, instance, FINDING_BEYOND_CALIBRATION, to);
  }
  memory[MEMORY_JAW] = state.jaw_m;
  memory[MEMORY_BEHIND] = state.behind_m;
  return force;
}

/* Seconds since the start of the step; none of a contact that begins, or if the time was set back. */
static double elapsed(const mjData* d, const mjtNum* start) {
  const double dt = d->time - start[MEMORY_TIME];
  return start[MEMORY_BEGUN] == 1 && dt > 0 && isfinite(dt) ? dt : 0;
}

static void measure(const contact* c, const mjtNum* memory, double force, const traction* friction, double place, mjtNum* measures) {
  const palpate_state state = {memory[MEMORY_JAW], memory[MEMORY_BEHIND]};
  double excess = 0;
  palpate_excess_strain(c->model, &state, &excess);
  measures[MEASURE_EXCESS_STRAIN] = excess;
  measures[MEASURE_NORMAL_FORCE] = force;
  measures[MEASURE_MARGIN_TO_SLIP] = friction->limit - friction->load;
  measures[MEASURE_TANGENTIAL_LOAD] = friction->load;
  measures[MEASURE_DISPLACEMENT] = place;
}

static void compute(const mjModel* m, mjData* d, int instance, int capability) {
  contact* c = contact_in(d, instance);
  mjtNum *state = d->plugin_state + m->plugin_stateadr[instance], memory[MEMORY_COUNT];
  traction friction = {{0, 0, 0}, 0, 0, 0};
  placement at = {0};
  double dt, force, to;
  int i;
  (void)capability;
  for (i = 0; i < MEMORY_COUNT; i++) {
    if (!isfinite(state[STATE_START + i])) {
      report(m, c, instance, FINDING_NOT_FINITE, 0);
      mju_zero(state, STATE_COUNT);
      break;
    }
  }
  mju_copy(memory, state + STATE_START, MEMORY_COUNT);
  dt = elapsed(d, memory);
  if (c->joint >= 0) {
    to = c->closing * (d->qpos[m->jnt_qposadr[c->joint]] - c->touch);
    at.displacement = to / c->sides;
    at.closing = c->closing * d->qvel[m->jnt_dofadr[c->joint]];
  } else {
    place_geoms(m, d, c, &at);
    follow(d, c, dt > 0, memory, &at);
    to = c->sides * at.displacement;
    /* Farther away nothing changes any more. */
    if (to < -c->sides * c->depth) to = -c->sides * c->depth;
  }
  if (!isfinite(to)) {
    /* The engine resets such a state itself; until then the jaw stays where it was. */
    report(m, c, instance, FINDING_NOT_FINITE, to);
    to = c->sides * memory[MEMORY_JAW];
  }
  force = squeeze(m, c, instance, dt, to, memory);
  /* Damping alone cannot pull. */
  if (c->normal_damping > 0 && force > 0 && isfinite(at.closing)) force = fmax(0, force + c->normal_damping * at.closing);
  if (c->joint >= 0) {
    d->qfrc_passive[m->jnt_dofadr[c->joint]] -= c->closing * force;
  } else if (at.displacement > -c->depth) {
    friction = bristle(c, &at, d->geom_xmat + 9 * c->geom1, force, memory);
    if (friction.limit > 0 && !c->is_step_known) check_step(m, d, c, instance, at.point);
    if (force != 0) apply(m, c, &at, force, &friction, d->qfrc_passive);
  } else {
    let_go(memory);
  }
  /* The stages of Runge and Kutta within a step are evaluations that no step ends with. */
  if (m->opt.integrator == mjINT_RK4 && state[STATE_IS_AHEAD] == 1 && d->time > state[STATE_NOW + MEMORY_TIME]) return;
  memory[MEMORY_BEGUN] = 1;
  memory[MEMORY_TIME] = d->time;
  mju_copy(state + STATE_NOW, memory, MEMORY_COUNT);
  state[STATE_IS_AHEAD] = 1;
  measure(c, memory, force, &friction, at.displacement, state + STATE_MEASURES);
}

static void advance(const mjModel* m, mjData* d, int instance) {
  mjtNum* state = d->plugin_state + m->plugin_stateadr[instance];
  if (state[STATE_IS_AHEAD] == 1) mju_copy(state + STATE_START, state + STATE_NOW, MEMORY_COUNT);
  state[STATE_IS_AHEAD] = 0;
}

static void reset(const mjModel* m, mjtNum* plugin_state, void* plugin_data, int instance) {
  contact* c = (contact*)plugin_data;
  (void)m;
  (void)instance;
  mju_zero(plugin_state, STATE_COUNT);
  if (c) memset(c->reported, 0, sizeof c->reported);
}

static int nstate(const mjModel* m, int instance) {
  (void)m;
  (void)instance;
  return STATE_COUNT;
}

static int init(const mjModel* m, mjData* d, int instance) {
  d->plugin_data[instance] = (uintptr_t)contact_of(m, instance);
  return 0;
}

static void destroy(mjData* d, int instance) {
  contact_free(contact_in(d, instance));
  d->plugin_data[instance] = 0;
}

void register_contact(void) {
  static const char* keys[] = {"material",           "description",    "geom1",    "geom2",    "joint",
                               "closing",            "touch",          "friction", "substeps", "torsional_friction",
                               "normal_damping",     "tangential_stiffness",       "tangential_damping"};
  mjpPlugin plugin;
  mjp_defaultPlugin(&plugin);
  plugin.name = CONTACT_PLUGIN;
  plugin.nattribute = sizeof keys / sizeof keys[0];
  plugin.attributes = keys;
  plugin.capabilityflags |= mjPLUGIN_PASSIVE;
  plugin.nstate = nstate;
  plugin.init = init;
  plugin.destroy = destroy;
  plugin.reset = reset;
  plugin.compute = compute;
  plugin.advance = advance;
  mjp_registerPlugin(&plugin);
}
