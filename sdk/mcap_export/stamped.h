// A message and its flight time.
#pragma once

namespace karst::mcap {

template <class Message>
struct Stamped {
  double t_s = 0;
  Message message;
};

}  // namespace karst::mcap
