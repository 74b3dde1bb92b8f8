// Losses by a counter of 16 bits that each packet of a sender carries.
#pragma once
#include <cstdint>

namespace karst::lidar {

class Sequence {
 public:
  enum class Arrival { fresh, duplicate };

  /// Takes in the number of a packet. Packets may overtake each other by up to 64. A greater jump is a
  /// counter that began anew: nothing is known of losses then.
  Arrival take(std::uint16_t number) {
    const auto ahead = static_cast<std::int16_t>(number - newest_);
    if (!begun_ || ahead > kFar || ahead <= -64) {
      begun_ = true;
      newest_ = number;
      seen_ = ~std::uint64_t{0};  // what came before the first is not missed
      return Arrival::fresh;
    }
    if (ahead > 0) {
      lost_ += static_cast<std::uint64_t>(ahead) - 1;
      seen_ = ahead < 64 ? seen_ << ahead | 1 : 1;
      newest_ = number;
      return Arrival::fresh;
    }
    const std::uint64_t bit = std::uint64_t{1} << -ahead;
    if ((seen_ & bit) != 0) return Arrival::duplicate;
    seen_ |= bit;
    --lost_;
    return Arrival::fresh;
  }
  std::uint64_t lost() const { return lost_; }

 private:
  static constexpr int kFar = 1024;
  bool begun_ = false;
  std::uint16_t newest_ = 0;
  std::uint64_t seen_ = 0;  // bit i: packet newest_ - i has come
  std::uint64_t lost_ = 0;
};

}  // namespace karst::lidar
