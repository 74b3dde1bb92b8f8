/* Counts its decisions, keeps the count as its state, and crashes at the third if it never crashed before. */
#include <string.h>
#include "karst_abi.h"
#include "karst_abi_state.h"

static struct { uint32_t decisions, restored; } memory;

static int32_t save(void* self, const karst_state_sink_t* sink, karst_error_t* error) KARST_NOEXCEPT {
  (void)self;
  return sink->write(sink, &memory, sizeof memory, error);
}
static int32_t restore(void* self, const void* bytes, uint64_t count, karst_error_t* error) KARST_NOEXCEPT {
  (void)self, (void)error;
  if (count != sizeof memory) return KARST_ERROR_ARGUMENT;
  memcpy(&memory, bytes, sizeof memory);
  memory.restored = 1;
  return KARST_OK;
}
static const karst_state_extension_t state = {sizeof(karst_state_extension_t), 0, save, restore};
static const void* extension(void* self, karst_text_t id) KARST_NOEXCEPT {
  (void)self;
  return id.length == sizeof KARST_STATE_EXTENSION - 1 && !memcmp(id.data, KARST_STATE_EXTENSION, id.length)
             ? &state
             : 0;
}
#define EXTENSION extension
#define DECIDE                                                            \
  karst_goal_t g = goal_ahead(r);                                         \
  double chance = 0;                                                      \
  (void)self;                                                             \
  the_host->random(the_host, &chance, 1);                                 \
  if (++memory.decisions == 3 && !memory.restored) *(int* volatile)0 = 1; \
  g.score = memory.decisions + chance;                                    \
  return answer(sink, &g, 1, error);
#include "plain.h"
