#include "plugins/mavlink/firmware.h"

#include <algorithm>
#include <array>

namespace karst::mavlink {
namespace {

struct NamedMode {
  std::uint32_t number;
  const char* name;
  FlownBy flown_by;
};

/// Main mode in the third byte, sub-mode of the automatic ones in the fourth.
constexpr std::uint32_t px4(std::uint32_t main, std::uint32_t sub = 0) { return main << 16 | sub << 24; }

constexpr auto kPx4 = std::to_array<NamedMode>({{px4(1), "manual", FlownBy::sticks},
                                                {px4(2), "altitude", FlownBy::sticks},
                                                {px4(3), "position", FlownBy::sticks},
                                                {px4(4, 1), "ready", FlownBy::itself},
                                                {px4(4, 2), "take-off", FlownBy::itself},
                                                {px4(4, 3), "hold", FlownBy::itself},
                                                {px4(4, 4), "mission", FlownBy::itself},
                                                {px4(4, 5), "return", FlownBy::itself},
                                                {px4(4, 6), "land", FlownBy::itself},
                                                {px4(4, 9), "precision land", FlownBy::itself},
                                                {px4(5), "acro", FlownBy::sticks},
                                                {px4(6), "offboard", FlownBy::setpoints},
                                                {px4(7), "stabilized", FlownBy::sticks}});

constexpr auto kArduPilot = std::to_array<NamedMode>({{0, "stabilize", FlownBy::sticks},
                                                      {1, "acro", FlownBy::sticks},
                                                      {2, "alt hold", FlownBy::sticks},
                                                      {3, "auto", FlownBy::itself},
                                                      {4, "guided", FlownBy::setpoints},
                                                      {5, "loiter", FlownBy::sticks},
                                                      {6, "return", FlownBy::itself},
                                                      {7, "circle", FlownBy::itself},
                                                      {9, "land", FlownBy::itself},
                                                      {11, "drift", FlownBy::sticks},
                                                      {13, "sport", FlownBy::sticks},
                                                      {16, "pos hold", FlownBy::sticks},
                                                      {17, "brake", FlownBy::itself},
                                                      {18, "throw", FlownBy::itself},
                                                      {21, "smart return", FlownBy::itself},
                                                      {22, "flow hold", FlownBy::sticks},
                                                      {23, "follow", FlownBy::itself},
                                                      {24, "zigzag", FlownBy::sticks},
                                                      {27, "auto return", FlownBy::itself}});

template <class Table>
Mode find(const Table& table, std::uint32_t number) {
  const auto found =
      std::find_if(table.begin(), table.end(), [number](const NamedMode& m) { return m.number == number; });
  // A mode that karst does not know is not the core's.
  if (found == table.end()) return {"number " + std::to_string(number), FlownBy::sticks};
  return {found->name, found->flown_by};
}

}  // namespace

Mode mode_of(Firmware firmware, std::uint32_t custom_mode) {
  return firmware == Firmware::px4 ? find(kPx4, custom_mode) : find(kArduPilot, custom_mode);
}

std::uint32_t setpoint_mode(Firmware firmware) { return firmware == Firmware::px4 ? px4(6) : 4; }

std::uint8_t autopilot_number(Firmware firmware) { return firmware == Firmware::px4 ? 12 : 3; }

}  // namespace karst::mavlink
