// Where a vehicle listens: `tcp:HOST:PORT`, `tcp:PORT` (127.0.0.1) or `unix:PATH`.
#pragma once
#include <cstdint>
#include <string>

namespace karst::socket {

struct Address {
  enum class Family { tcp, unix_path };
  Family family = Family::tcp;
  std::string host;  // of tcp: name or number, without the brackets of [::1]
  std::uint16_t port = 0;
  std::string path;  // of unix

  std::string text() const;
};

/// Throws core::InputError naming what is wrong with `text`.
Address parse_address(const std::string& text);

}  // namespace karst::socket
