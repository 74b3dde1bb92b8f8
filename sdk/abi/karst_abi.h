/*
 * karst policy ABI: the one symbol a policy plugin exports, and the handshake.
 *
 * A plugin is a shared object that exports exactly `karst_plugin_entry`. The host opens it with
 * RTLD_NOW | RTLD_LOCAL, checks that the symbol belongs to that file, and never closes it.
 *
 * Handshake: `abi_major` must equal the host's KARST_ABI_MAJOR; `abi_minor` must not exceed the host's. An
 * older minor version is accepted, since every later addition is an optional slot or an extension. The first
 * three fields of karst_plugin_t are the same in every major version, so that a mismatch can be reported.
 */
#ifndef KARST_ABI_H
#define KARST_ABI_H
#include "karst_abi_policy.h"
#include "karst_abi_state.h"

#define KARST_ABI_MAJOR 1
#define KARST_ABI_MINOR 0

#if defined(__GNUC__) || defined(__clang__)
#define KARST_EXPORT __attribute__((visibility("default")))
#else
#define KARST_EXPORT
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* [appendable] What the entry returns; lives as long as the process. */
typedef struct karst_plugin {
  uint32_t size;
  uint32_t abi_major; /* KARST_ABI_MAJOR the plugin was compiled with */
  uint32_t abi_minor; /* KARST_ABI_MINOR the plugin was compiled with */
  uint32_t policy_count;
  /* [any thread] Policy `index` < policy_count; the same pointer every time. */
  const karst_policy_t* (*policy)(uint32_t index)KARST_NOEXCEPT;
} karst_plugin_t;

/* [any thread] Returns the table and does no other work: the host also calls it to list plugins. */
typedef const karst_plugin_t* (*karst_plugin_entry_fn)(void)KARST_NOEXCEPT;

#define KARST_PLUGIN_ENTRY_NAME "karst_plugin_entry"

/* Defined by the plugin, with external visibility. */
KARST_EXPORT const karst_plugin_t* karst_plugin_entry(void) KARST_NOEXCEPT;

#ifdef __cplusplus
}
#endif
#endif
