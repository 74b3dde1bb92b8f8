/*
 * karst policy ABI, extension "karst.state/1": what a policy remembers, as bytes.
 *
 * A policy that crashed or hung is started once more. With this extension the new object goes on with the
 * memory of the old one; without it, it begins anew. The table is what karst_policy_t::extension returns for
 * KARST_STATE_EXTENSION. A host that does not know the extension never asks, a policy that does not offer it
 * returns NULL: neither needs another ABI version for it.
 *
 * The bytes are the policy's own. The host keeps them with the policy's id and version and the parameters,
 * and gives them back only where all three agree, on the same kind of machine. They may still be cut short or
 * damaged, by the very crash they are to bridge: restore() checks what it reads.
 *
 * Not part of the state: the position in the host's random stream, which the host keeps, and map snapshots,
 * which end with the object that retained them.
 */
#ifndef KARST_ABI_STATE_H
#define KARST_ABI_STATE_H
#include "karst_abi_types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define KARST_STATE_EXTENSION "karst.state/1"

/* [appendable] Where saved bytes go. [decision thread] Valid until save() returns. */
typedef struct karst_state_sink {
  uint32_t size;
  uint32_t reserved;
  uint64_t max_bytes; /* what this host keeps of one policy, at least 1 MiB */
  void* context;      /* the host's own */
  /* Adds bytes at the end. More than max_bytes in total is KARST_ERROR_LIMIT. */
  int32_t (*write)(const struct karst_state_sink*, const void* bytes, uint64_t count,
                   karst_error_t*) KARST_NOEXCEPT;
} karst_state_sink_t;

/* [appendable] Both slots are mandatory. A nonzero return with a filled error is a failure. */
typedef struct karst_state_extension {
  uint32_t size;
  uint32_t reserved;
  /* [decision thread] {active} Between two calls. Changes nothing: the policy answers as if it had not been
     asked. May be called after every decision, so it should take no more than a few milliseconds. After a
     failure the host keeps what it had. */
  int32_t (*save)(void* self, const karst_state_sink_t*, karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {initialized} Once, before the first activate. After a failure nothing but
     destroy() may be called; the host then starts an object that remembers nothing. */
  int32_t (*restore)(void* self, const void* bytes, uint64_t count, karst_error_t*) KARST_NOEXCEPT;
} karst_state_extension_t;

#ifdef __cplusplus
}
#endif
#endif
