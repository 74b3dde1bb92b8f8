#include "core_stack/team/communication/record_store.h"

namespace karst::core {

RecordStore::Taken RecordStore::take(const SentRecord& r) {
  HeldNumbers& held = held_[r.author];
  if (held.holds(r.number)) return find(r.author, r.number)->bytes == r.bytes ? Taken::known : Taken::differs;
  if (r.number > max_records_) return Taken::full;
  if (!held.takes(r.number)) return Taken::too_far;
  records_[{r.author, r.number}] = r;  // first: without memory for it, it must not count as held
  held.add(r.number);
  return Taken::fresh;
}

const SentRecord* RecordStore::find(RobotId author, std::uint32_t number) const {
  const auto found = records_.find({author, number});
  return found == records_.end() ? nullptr : &found->second;
}

}  // namespace karst::core
