/* The interface from C: golden values of the paper's ball, many contacts, bytes, refusals, two threads on one model.
 *
 *   steps MATERIAL.toml
 *
 * prints the forces of a run as hexadecimal doubles, which the test in Rust compares with its own to the last bit. */

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "palpate.h"

#define CHECK(condition)                                                                   \
  do {                                                                                     \
    if (!(condition)) {                                                                    \
      fprintf(stderr, "%s:%d: expected %s\n", __FILE__, __LINE__, #condition);             \
      exit(1);                                                                             \
    }                                                                                      \
  } while (0)

static const char BALL[] =
    "[specimen]\nshape = \"ball\"\nradius = \"35 mm\"\nmodulus = \"28 kPa\"\n"
    "[law]\nname = \"latency\"\nexponent = 5\nrate_coefficient = \"2e4 /s\"\n";

static palpate_model *ball(void) {
  palpate_model *model = NULL;
  char message[200];
  CHECK(palpate_model_from_text(BALL, NULL, &model, message, sizeof message) == PALPATE_STATUS_OK);
  CHECK(model != NULL && message[0] == '\0');
  return model;
}

/* 5 mm at 500 mm/min and a hold of 10 s: 3.0350250075 N and 1.5561334317 N (docs/theory/contact-simulation.md). */
static void golden(const palpate_model *model) {
  palpate_state state = {0.0, 0.0};
  double force = 0.0, stiffness = 0.0;
  int tick;
  for (tick = 1; tick <= 600; tick++) {
    CHECK(palpate_step(model, &state, 1e-3, 0.005 * tick / 600.0, &force) == PALPATE_STATUS_OK);
    printf("%a\n", force);
  }
  CHECK(fabs(force - 3.0350250075) < 1e-3);
  CHECK(palpate_step(model, &state, 10.0, 0.005, &force) == PALPATE_STATUS_OK);
  printf("%a\n", force);
  CHECK(fabs(force - 1.5561334317) < 1e-4);
  CHECK(palpate_stiffness(model, &state, &stiffness) == PALPATE_STATUS_OK);
  printf("%a\n", stiffness);
}

static void bytes(const palpate_model *model) {
  palpate_state state = {0.0, 0.0}, other = {1.0, 1.0};
  uint8_t saved[PALPATE_STATE_BYTES];
  CHECK(palpate_step(model, &state, 0.01, 0.003, NULL) == PALPATE_STATUS_OK);
  CHECK(palpate_state_save(&state, saved) == PALPATE_STATUS_OK);
  CHECK(palpate_state_restore(saved, &other) == PALPATE_STATUS_OK);
  CHECK(memcmp(&state, &other, sizeof state) == 0);
  saved[0] = 'x';
  CHECK(palpate_state_restore(saved, &other) == PALPATE_STATUS_STATE_BYTES);
  CHECK(memcmp(&state, &other, sizeof state) == 0);
}

static void refusals(const palpate_model *model) {
  palpate_state state = {0.0, 0.0}, untouched = {0.0, 0.0};
  char message[80];
  double force = 5.0;
  CHECK(palpate_step(NULL, &state, 1e-3, 0.001, &force) == PALPATE_STATUS_NULL_POINTER);
  CHECK(palpate_step(model, NULL, 1e-3, 0.001, &force) == PALPATE_STATUS_NULL_POINTER);
  CHECK(palpate_step(model, &state, NAN, 0.001, &force) == PALPATE_STATUS_NOT_FINITE);
  CHECK(palpate_step(model, &state, 1e-3, 0.5, &force) == PALPATE_STATUS_DISPLACEMENT);
  CHECK(palpate_step_force(model, &state, 1e-3, -1.0, &force) == PALPATE_STATUS_FORCE);
  CHECK(force == 5.0 && memcmp(&state, &untouched, sizeof state) == 0);
  CHECK(palpate_step_message(model, &state, 1e-3, 0.5, message, sizeof message) == PALPATE_STATUS_DISPLACEMENT);
  CHECK(strcmp(message, "contact displacement must stay below the radius of 0.035 m, found 0.25 m") == 0);
  CHECK(palpate_step_message(model, &state, 1e-3, 0.5, message, 9) == PALPATE_STATUS_DISPLACEMENT);
  CHECK(strcmp(message, "contact ") == 0);
  CHECK(strcmp(palpate_status_text(PALPATE_STATUS_OK), "done") == 0);
  CHECK(palpate_abi_version() == PALPATE_ABI_VERSION && palpate_version()[0] == '0');
}

static void many(const palpate_model *model) {
  enum { COUNT = 1000 };
  palpate_state *states = calloc(COUNT, sizeof *states);
  double *to = malloc(COUNT * sizeof *to), *force = malloc(COUNT * sizeof *force);
  palpate_status *status = malloc(COUNT * sizeof *status);
  double dt = 1e-3;
  palpate_many all;
  int index;
  CHECK(states && to && force && status);
  for (index = 0; index < COUNT; index++) to[index] = 1e-5 * index;
  to[7] = NAN;
  memset(&all, 0, sizeof all);
  all.count = COUNT;
  all.models = &model;
  all.states = states;
  all.state_stride = sizeof *states;
  all.dt_s = &dt;
  all.to = to;
  all.to_stride = sizeof *to;
  all.results = force;
  all.statuses = status;
  CHECK(palpate_step_many(&all) == PALPATE_STATUS_SOME_REFUSED);
  for (index = 0; index < COUNT; index++) {
    palpate_state alone = {0.0, 0.0};
    double expected;
    if (index == 7) {
      CHECK(status[index] == PALPATE_STATUS_NOT_FINITE && states[index].jaw_m == 0.0);
      continue;
    }
    CHECK(palpate_step(model, &alone, dt, to[index], &expected) == PALPATE_STATUS_OK);
    CHECK(status[index] == PALPATE_STATUS_OK && force[index] == expected);
  }
  free(states);
  free(to);
  free(force);
  free(status);
}

/* Two threads, one model, a state each: the same forces. */
static void *run(void *model) {
  palpate_state state = {0.0, 0.0};
  double *force = malloc(sizeof *force);
  int tick;
  CHECK(force);
  for (tick = 1; tick <= 2000; tick++)
    CHECK(palpate_step(model, &state, 1e-3, 1e-5 * (tick % 500), force) == PALPATE_STATUS_OK);
  return force;
}

static void threads(palpate_model *model) {
  pthread_t thread[2];
  void *force[2];
  int index;
  for (index = 0; index < 2; index++) CHECK(pthread_create(&thread[index], NULL, run, model) == 0);
  for (index = 0; index < 2; index++) CHECK(pthread_join(thread[index], &force[index]) == 0);
  CHECK(*(double *)force[0] == *(double *)force[1]);
  free(force[0]);
  free(force[1]);
}

int main(int count, char **arguments) {
  palpate_model *model = ball(), *material = NULL;
  char message[300];
  double calibrated = 0.0;
  int32_t is_bonded = -1;
  golden(model);
  bytes(model);
  refusals(model);
  many(model);
  threads(model);
  CHECK(count == 2);
  CHECK(palpate_model_from_file(arguments[1], &material, message, sizeof message) == PALPATE_STATUS_OK);
  CHECK(palpate_model_calibrated_m(material, &calibrated) == PALPATE_STATUS_OK && calibrated < 0.1);
  CHECK(palpate_model_is_bonded(material, &is_bonded) == PALPATE_STATUS_OK && is_bonded == 0);
  CHECK(palpate_model_from_file("/no/such/file.toml", &material, message, sizeof message) == PALPATE_STATUS_DESCRIPTION);
  CHECK(strstr(message, "/no/such/file.toml") != NULL);
  CHECK(palpate_model_free(material) == PALPATE_STATUS_OK);
  CHECK(palpate_model_free(model) == PALPATE_STATUS_OK);
  return 0;
}
