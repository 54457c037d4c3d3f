/* palpate: soft contact with memory, one step at a time.
 *
 * Written by cbindgen from crates/palpate-c; docs/guides/simulators-c.md explains it.
 */

#ifndef PALPATE_H
#define PALPATE_H

#include <stddef.h>
#include <stdint.h>

/*
 Length of the bytes of a state.
 */
#define PALPATE_STATE_BYTES 24

/*
 Version of this interface: another number where a function, a struct or a code has changed its meaning.
 */
#define PALPATE_ABI_VERSION 1

/*
 The outcome of a call.
 */
enum palpate_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /*
   Done.
   */
  PALPATE_STATUS_OK = 0,
  /*
   A pointer that must not be null is null.
   */
  PALPATE_STATUS_NULL_POINTER = 1,
  /*
   A time step, displacement, force or state that is NaN or infinite, or a time step below 0.
   */
  PALPATE_STATUS_NOT_FINITE = 2,
  /*
   A displacement that the body cannot take.
   */
  PALPATE_STATUS_DISPLACEMENT = 3,
  /*
   A force that no displacement carries, or that pulls where nothing can be pulled.
   */
  PALPATE_STATUS_FORCE = 4,
  /*
   Bytes of something else than a state of this format.
   */
  PALPATE_STATUS_STATE_BYTES = 5,
  /*
   A file or a text that is no description of a body and its law.
   */
  PALPATE_STATUS_DESCRIPTION = 6,
  /*
   A law that is not stepped: any but the latency law with one rate coefficient.
   */
  PALPATE_STATUS_LAW = 7,
  /*
   A result beyond the range of double precision.
   */
  PALPATE_STATUS_RANGE = 8,
  /*
   Some contacts of many were not stepped; the others were.
   */
  PALPATE_STATUS_SOME_REFUSED = 9,
  /*
   A defect of this library; nothing was written.
   */
  PALPATE_STATUS_INTERNAL = 10,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum palpate_status palpate_status;
#else
typedef int32_t palpate_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/*
 A body with its law: what turns motion into force. It never changes, and any number of threads may use it at once.
 */
typedef struct palpate_model palpate_model;

/*
 The state of one contact: two doubles, to be copied and kept anywhere. All zeros are a body that nothing has touched yet.
 */
typedef struct palpate_state {
  /*
   One contact's share of the displacement of the jaw, m.
   */
  double jaw_m;
  /*
   Displacement of the node behind the contact layer, m.
   */
  double behind_m;
} palpate_state;

/*
 Contacts that are stepped by one call, over arrays of the caller.

 A stride is the distance in bytes between an entry and the next, as in NumPy; 0 makes the first entry stand for all contacts. So states may
 be parts of a larger struct. Entries must be aligned as their type is.
 */
typedef struct palpate_many {
  /*
   Number of contacts.
   */
  size_t count;
  /*
   Pointers to models, one a contact or one for all.
   */
  const struct palpate_model *const *models;
  /*
   Bytes from one of them to the next.
   */
  size_t model_stride;
  /*
   States, one a contact.
   */
  struct palpate_state *states;
  /*
   Bytes from one of them to the next, at least the size of a state.
   */
  size_t state_stride;
  /*
   Time steps in s.
   */
  const double *dt_s;
  /*
   Bytes from one of them to the next.
   */
  size_t dt_stride;
  /*
   Where the steps end: displacements of the jaws in m, or forces in N.
   */
  const double *to;
  /*
   Bytes from one of them to the next.
   */
  size_t to_stride;
  /*
   Results, `count` of them side by side: forces in N, or displacements of the jaws in m; those of refused steps stay as they are. May be
   null.
   */
  double *results;
  /*
   Codes of the contacts, `count` of them side by side. May be null.
   */
  palpate_status *statuses;
} palpate_many;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/*
 The text of a code, in English and in static memory; one of its own for numbers that are no code.
 */
const char *palpate_status_text(int32_t status);

/*
 Reads a model from a file: a material of `palpate calibrate`, or the tables specimen, law and contact of a protocol, whose steps are ignored.

 `path` is UTF-8. `message` may be null; it takes at most `capacity` bytes with the closing zero: why there is no model, with file, line and
 key, or nothing. The model must be freed by `palpate_model_free`.

 # Safety
 Each pointer is null or valid, `path` up to its closing zero and `message` for `capacity` bytes.
 */
palpate_status palpate_model_from_file(const char *path,
                                       struct palpate_model **model,
                                       char *message,
                                       size_t capacity);

/*
 Reads a model from TOML text, as `palpate_model_from_file` does from a file.

 `name` stands in messages, and a `material = "FILE"` in the text is sought beside it; null is a text in the working directory.

 # Safety
 Each pointer is null or valid, `toml` and `name` up to their closing zeros and `message` for `capacity` bytes.
 */
palpate_status palpate_model_from_text(const char *toml,
                                       const char *name,
                                       struct palpate_model **model,
                                       char *message,
                                       size_t capacity);

/*
 Frees a model; null is ignored. Nothing may use it any more.

 # Safety
 Null, or a model of this library that was not freed before.
 */
palpate_status palpate_model_free(struct palpate_model *model);

/*
 Number of sides from which the body is squeezed: 2, and each contact takes half the displacement of the jaws, or 1.

 # Safety
 Each pointer is null or valid.
 */
palpate_status palpate_model_sides(const struct palpate_model *model,
                                   int32_t *sides);

/*
 Distance in m from an undeformed contact to the plane of the body that does not move, such as the radius of a ball.

 # Safety
 Each pointer is null or valid.
 */
palpate_status palpate_model_depth_m(const struct palpate_model *model,
                                     double *depth_m);

/*
 The largest displacement of the jaw in m that `palpate_step` accepts; infinite of a prism bonded to its grips.

 # Safety
 Each pointer is null or valid.
 */
palpate_status palpate_model_deepest_m(const struct palpate_model *model,
                                       double *deepest_m);

/*
 1 where the body counts as bonded to its jaw (`separation = false`), which then pulls below 0 m from any distance; 0 where the jaw lets go.

 # Safety
 Each pointer is null or valid.
 */
palpate_status palpate_model_is_bonded(const struct palpate_model *model,
                                       int32_t *is_bonded);

/*
 The deepest displacement of the jaw in m in the test that a material was calibrated by; infinite of a body that was described.

 # Safety
 Each pointer is null or valid.
 */
palpate_status palpate_model_calibrated_m(const struct palpate_model *model,
                                          double *calibrated_m);

/*
 Contact force in N; 0 while the jaw is off.

 # Safety
 Each pointer is null or valid; nothing writes to model and state meanwhile.
 */
palpate_status palpate_force(const struct palpate_model *model,
                             const struct palpate_state *state,
                             double *force_n);

/*
 Tangent stiffness in N/m: slope of the force against the displacement of the jaw for a step of 0 s; 0 while the jaw is off.

 # Safety
 Each pointer is null or valid; nothing writes to model and state meanwhile.
 */
palpate_status palpate_stiffness(const struct palpate_model *model,
                                 const struct palpate_state *state,
                                 double *stiffness_n_per_m);

/*
 Strain of the contact layer in excess of equilibrium.

 # Safety
 Each pointer is null or valid; nothing writes to model and state meanwhile.
 */
palpate_status palpate_excess_strain(const struct palpate_model *model,
                                     const struct palpate_state *state,
                                     double *excess_strain);

/*
 Displacement of the surface of the body at one contact in m: where the jaw is or, once it is off, the dent that remains.

 # Safety
 Each pointer is null or valid; nothing writes to model and state meanwhile.
 */
palpate_status palpate_surface(const struct palpate_model *model,
                               const struct palpate_state *state,
                               double *surface_m);

/*
 Whether the jaw touches the body: 1, or 0.

 # Safety
 Each pointer is null or valid; nothing writes to model and state meanwhile.
 */
palpate_status palpate_is_touching(const struct palpate_model *model,
                                   const struct palpate_state *state,
                                   int32_t *touching);

/*
 Writes a state as PALPATE_STATE_BYTES bytes, the same on every machine.

 # Safety
 Each pointer is null or valid, `bytes` for PALPATE_STATE_BYTES bytes.
 */
palpate_status palpate_state_save(const struct palpate_state *state, uint8_t *bytes);

/*
 Reads a state from the bytes of `palpate_state_save`, to the last bit.

 # Safety
 Each pointer is null or valid, `bytes` for PALPATE_STATE_BYTES bytes.
 */
palpate_status palpate_state_restore(const uint8_t *bytes, struct palpate_state *state);

/*
 Moves many jaws to their displacements within their time steps, each as `palpate_step` does.

 A contact that cannot be stepped stays as it was, has its own code and no new result; the others are stepped, and the call returns
 PALPATE_STATUS_SOME_REFUSED.

 # Safety
 `many` is null or valid; its arrays are null or have `count` entries at their strides, and nothing else uses states, results and codes
 meanwhile.
 */
palpate_status palpate_step_many(const struct palpate_many *many);

/*
 Brings many forces to their values within their time steps, each as `palpate_step_force` does; otherwise as `palpate_step_many`.

 # Safety
 As for `palpate_step_many`.
 */
palpate_status palpate_step_force_many(const struct palpate_many *many);

/*
 Moves the jaw to `displacement_m` (since first touch) within `dt_s` (0 or more) and writes the force at the end in N.

 Of a body squeezed from two sides the displacement is that of both jaws together, and each contact takes half of it. `force_n` may be null.
 A step of 0 s takes the motion at once. Refused steps leave the state as it was.

 # Safety
 Each pointer is null or valid; nothing else uses the state meanwhile.
 */
palpate_status palpate_step(const struct palpate_model *model,
                            struct palpate_state *state,
                            double dt_s,
                            double displacement_m,
                            double *force_n);

/*
 Brings the force to `force_n` within `dt_s` (0 or more) and writes the displacement of the jaw at the end in m.

 `displacement_m` may be null. Refused steps leave the state as it was.

 # Safety
 Each pointer is null or valid; nothing else uses the state meanwhile.
 */
palpate_status palpate_step_force(const struct palpate_model *model,
                                  struct palpate_state *state,
                                  double dt_s,
                                  double force_n,
                                  double *displacement_m);

/*
 Writes why `palpate_step` refuses such a step: what was expected and what was found, at most `capacity` bytes with the closing zero.

 It writes an empty message where the step would be taken. The state stays as it is. Returns what `palpate_step` would.

 # Safety
 Each pointer is null or valid, `message` for `capacity` bytes; nothing writes to the state meanwhile.
 */
palpate_status palpate_step_message(const struct palpate_model *model,
                                    const struct palpate_state *state,
                                    double dt_s,
                                    double displacement_m,
                                    char *message,
                                    size_t capacity);

/*
 Writes why `palpate_step_force` refuses such a step, as `palpate_step_message` does.

 # Safety
 Each pointer is null or valid, `message` for `capacity` bytes; nothing writes to the state meanwhile.
 */
palpate_status palpate_step_force_message(const struct palpate_model *model,
                                          const struct palpate_state *state,
                                          double dt_s,
                                          double force_n,
                                          char *message,
                                          size_t capacity);

/*
 PALPATE_ABI_VERSION of the library that is linked; that of the header must be the same.
 */
uint32_t palpate_abi_version(void);

/*
 Version of palpate, such as "0.1.0", in static memory.
 */
const char *palpate_version(void);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* PALPATE_H */
