/*
 * karst policy ABI, extension "karst.state/1": the state of a policy, serialized as bytes.
 *
 * A policy that crashed or hung is restarted once. With this extension the new object continues with the
 * state of the old one; without it, it starts afresh. karst_policy_t::extension returns this table for
 * KARST_STATE_EXTENSION. A host that does not know the extension never asks for it, and a policy that does
 * not offer it returns NULL: neither needs another ABI version for it.
 *
 * The policy alone defines the bytes. The host keeps them with the policy's id, version and parameters, and
 * returns them only where all three agree, on the same kind of machine. They may still be truncated or
 * damaged by the crash that they are meant to survive: restore() must check what it reads.
 *
 * Not part of the state: the position in the host's random stream, which the host keeps, and map snapshots,
 * which are released with the object that retained them.
 */
#ifndef KARST_ABI_STATE_H
#define KARST_ABI_STATE_H
#include "karst_abi_types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define KARST_STATE_EXTENSION "karst.state/1"

/* [appendable] Receives the saved bytes. [decision thread] Valid until save() returns. */
typedef struct karst_state_sink {
  uint32_t size;
  uint32_t reserved;
  uint64_t max_bytes; /* the most that this host keeps for one policy, at least 1 MiB */
  void* context;      /* for the host's use only */
  /* Adds bytes at the end. More than max_bytes in total is KARST_ERROR_LIMIT. */
  int32_t (*write)(const struct karst_state_sink*, const void* bytes, uint64_t count,
                   karst_error_t*) KARST_NOEXCEPT;
} karst_state_sink_t;

/* [appendable] Both slots are mandatory. A nonzero return with a filled error is a failure. */
typedef struct karst_state_extension {
  uint32_t size;
  uint32_t reserved;
  /* [decision thread] {active} Called between two other calls. Must not change the policy's later answers.
     May be called after every decision, so it should take no more than a few milliseconds. After a failure
     the host keeps the state saved before. */
  int32_t (*save)(void* self, const karst_state_sink_t*, karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {initialized} Called once, before the first activate. After a failure only destroy()
     is called; the host then starts a new object without a saved state. */
  int32_t (*restore)(void* self, const void* bytes, uint64_t count, karst_error_t*) KARST_NOEXCEPT;
} karst_state_extension_t;

#ifdef __cplusplus
}
#endif
#endif
