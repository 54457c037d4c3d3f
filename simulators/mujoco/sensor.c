/* palpate.sensor: what a palpate.contact measures, five numbers in the order of `measure_index`. */
#include <stdint.h>
#include <string.h>

#include "plugin.h"

/* The instance that the key `contact` names. */
static int contact_named(const mjModel* m, int instance) {
  const char* name = mj_getPluginConfig(m, instance, "contact");
  const int id = name && name[0] ? mj_name2id(m, mjOBJ_PLUGIN, name) : -1;
  const mjpPlugin* plugin = id >= 0 ? mjp_getPluginAtSlot(m->plugin[id]) : NULL;
  if (!plugin || strcmp(plugin->name, CONTACT_PLUGIN) != 0) {
    mju_error("%s: contact: expected the name of an instance of %s, found \"%s\"", SENSOR_PLUGIN, CONTACT_PLUGIN, name ? name : "");
  }
  return id;
}

static int nstate(const mjModel* m, int instance) {
  (void)m;
  (void)instance;
  return 0;
}

static int nsensordata(const mjModel* m, int instance, int sensor) {
  (void)m;
  (void)instance;
  (void)sensor;
  return MEASURE_COUNT;
}

static int init(const mjModel* m, mjData* d, int instance) {
  d->plugin_data[instance] = (uintptr_t)contact_named(m, instance);
  return 0;
}

static void reset(const mjModel* m, mjtNum* plugin_state, void* plugin_data, int instance) {
  (void)m;
  (void)plugin_state;
  (void)plugin_data;
  (void)instance;
}

static void compute(const mjModel* m, mjData* d, int instance, int capability) {
  const int contact = (int)d->plugin_data[instance];
  const mjtNum* measures = d->plugin_state + m->plugin_stateadr[contact] + STATE_MEASURES;
  int i;
  (void)capability;
  for (i = 0; i < m->nsensor; i++) {
    if (m->sensor_type[i] == mjSENS_PLUGIN && m->sensor_plugin[i] == instance) {
      mju_copy(d->sensordata + m->sensor_adr[i], measures, MEASURE_COUNT);
    }
  }
}

void register_sensor(void) {
  static const char* keys[] = {"contact"};
  mjpPlugin plugin;
  mjp_defaultPlugin(&plugin);
  plugin.name = SENSOR_PLUGIN;
  plugin.nattribute = 1;
  plugin.attributes = keys;
  plugin.capabilityflags |= mjPLUGIN_SENSOR;
  /* After the passive forces of the same instant. */
  plugin.needstage = mjSTAGE_VEL;
  plugin.nstate = nstate;
  plugin.nsensordata = nsensordata;
  plugin.init = init;
  plugin.reset = reset;
  plugin.compute = compute;
  mjp_registerPlugin(&plugin);
}

__attribute__((constructor)) static void register_plugins(void) {
  if (palpate_abi_version() != PALPATE_ABI_VERSION) {
    mju_error("palpate: expected version %d of the C interface, found %d", PALPATE_ABI_VERSION, (int)palpate_abi_version());
  }
  register_contact();
  register_sensor();
}
