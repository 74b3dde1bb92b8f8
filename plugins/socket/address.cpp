#include "plugins/socket/address.h"

#include <sys/un.h>

#include <charconv>

#include "core_stack/common/error.h"

namespace karst::socket {
namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw core::InputError(text.empty() ? "the address" : text, "",
                         why + "; expected tcp:HOST:PORT, tcp:PORT or unix:PATH");
}

}  // namespace

std::string Address::text() const {
  if (family == Family::unix_path) return "unix:" + path;
  const bool brackets = host.find(':') != std::string::npos;
  return "tcp:" + (brackets ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

Address parse_address(const std::string& text) {
  Address a;
  if (text.starts_with("unix:")) {
    a.family = Address::Family::unix_path;
    a.path = text.substr(5);
    if (a.path.empty() || a.path.size() >= sizeof(sockaddr_un::sun_path))
      refuse(text, "the path is empty or too long");
    return a;
  }
  if (!text.starts_with("tcp:")) refuse(text, text.empty() ? "is missing" : "names no kind of socket");
  const std::string rest = text.substr(4);
  const std::size_t colon = rest.rfind(':');
  a.host = colon == std::string::npos ? "127.0.0.1" : rest.substr(0, colon);
  if (a.host.size() > 1 && a.host.front() == '[' && a.host.back() == ']')
    a.host = a.host.substr(1, a.host.size() - 2);
  if (a.host.empty()) refuse(text, "the host is empty");
  const std::string port = colon == std::string::npos ? rest : rest.substr(colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), a.port);
  if (error != std::errc() || end != port.data() + port.size())
    refuse(text, "the port is no number up to 65535");
  return a;
}

}  // namespace karst::socket
