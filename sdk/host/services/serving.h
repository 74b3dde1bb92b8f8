// The common part of all services: check the arguments, then run inside the session's gate.
#pragma once
#include <cmath>
#include <cstdint>
#include <string>

#include "sdk/abi/karst_abi.h"
#include "sdk/host/boundary/text.h"
#include "sdk/host/services/session.h"

namespace karst::host {

struct Refusal {
  std::int32_t code;
  std::string text;
};

inline void require(bool holds, const char* text) {
  if (!holds) throw Refusal{KARST_ERROR_ARGUMENT, text};
}

inline void require_batch(std::uint64_t count, std::uint64_t limit, const void* in, const void* out) {
  if (count > limit)
    throw Refusal{KARST_ERROR_LIMIT,
                  std::to_string(count) + " items in one call, the limit is " + std::to_string(limit)};
  require(count == 0 || (in != nullptr && out != nullptr), "an array is NULL");
}

inline bool finite(const karst_vec3_t& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline void require_box(const karst_box_t& b) {
  require(
      finite(b.low) && finite(b.high) && b.low.x <= b.high.x && b.low.y <= b.high.y && b.low.z <= b.high.z,
      "a box is not finite, or its low corner is above its high one");
}

struct Serving {
  static Session& session(const karst_host_t* host) { return *static_cast<Session*>(host->context); }

  /// Runs `work(session)` inside the gate; an exception becomes an error code.
  template <class Work>
  static std::int32_t serve(const karst_host_t* host, karst_error_t* error, Work&& work) noexcept {
    Refusal refusal{KARST_ERROR_FAILED, "the host ran out of memory"};
    try {
      Session& s = session(host);
      const std::shared_lock lock(s.gate_);
      check_not_abandoned(s);
      work(s);
      return KARST_OK;
    } catch (Refusal& r) {
      refusal = std::move(r);
    } catch (const std::exception& e) {
      refusal.text = e.what();
    }
    fill_error(error, refusal.code, refusal.text);
    return refusal.code;
  }

  static void check_not_abandoned(const Session& s) {
    if (s.abandoned_) throw Refusal{KARST_ERROR_ABANDONED, "the host has given up this policy"};
  }
  static void on_decision_thread(const Session& s) {
    if (std::this_thread::get_id() != s.decision_thread_)
      throw Refusal{KARST_ERROR_THREAD, "this slot is for the decision thread only"};
  }
};

}  // namespace karst::host
