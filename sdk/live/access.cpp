#include "sdk/live/access.h"

#include <arpa/inet.h>
#include <sodium.h>

#include <algorithm>
#include <charconv>

#include "core_stack/common/error.h"

namespace karst::live {
namespace {

bool is_address(const std::string& text) {
  in6_addr ignored{};
  return inet_pton(AF_INET, text.c_str(), &ignored) == 1 || inet_pton(AF_INET6, text.c_str(), &ignored) == 1;
}

}  // namespace

Endpoint endpoint_of(const std::string& text, const std::string& option) {
  const auto refuse = [&](const std::string& why) {
    throw core::InputError("karst fly", option + "=" + text, why);
  };
  Endpoint out;
  std::string_view rest = text;
  std::string_view address;
  if (rest.starts_with('[')) {
    const std::size_t end = rest.find(']');
    if (end == std::string_view::npos) refuse("the bracket of an IPv6 address is not closed");
    address = rest.substr(1, end - 1);
    rest.remove_prefix(end + 1);
    if (address.empty()) refuse("no address between the brackets");
  } else {
    address = rest.substr(0, rest.find(':'));
    rest.remove_prefix(address.size());
  }
  if (!address.empty()) out.address = address;
  if (out.address.find('\0') != std::string::npos || !is_address(out.address))
    refuse("expected ADDRESS:PORT with a numeric address, such as 127.0.0.1:8765 or [::1]:8765");
  if (rest.empty()) return out;
  unsigned port = 0;
  const auto [end, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), port);
  if (rest.front() != ':' || error != std::errc() || end != rest.data() + rest.size() || port > 65535)
    refuse("the port is a number from 0 to 65535");
  out.port = static_cast<std::uint16_t>(port);
  return out;
}

bool is_loopback(const Endpoint& endpoint) {
  return endpoint.address.starts_with("127.") || endpoint.address == "::1";
}

std::string text_of(const Endpoint& e) {
  const bool v6 = e.address.find(':') != std::string::npos;
  return (v6 ? "[" + e.address + "]" : e.address) + ":" + std::to_string(e.port);
}

bool is_token(std::string_view text) {
  return text.size() >= 8 && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  std::string_view("-._~").find(c) != std::string_view::npos;
         });
}

std::string_view token_of(std::string_view target, std::string_view authorization) {
  if (const std::size_t query = target.find('?'); query != std::string_view::npos) {
    std::string_view rest = target.substr(query + 1);
    while (!rest.empty()) {
      const std::string_view one = rest.substr(0, rest.find('&'));
      constexpr std::string_view kName = "token=";
      if (one.starts_with(kName)) return one.substr(kName.size());
      rest.remove_prefix(std::min(rest.size(), one.size() + 1));
    }
  }
  constexpr std::string_view kBearer = "Bearer ";
  return authorization.starts_with(kBearer) ? authorization.substr(kBearer.size()) : std::string_view();
}

bool same_token(std::string_view given, std::string_view expected) {
  return given.size() == expected.size() &&
         sodium_memcmp(given.data(), expected.data(), expected.size()) == 0;
}

bool is_from_here(std::string_view host, std::string_view origin) {
  const auto names_here = [](std::string_view authority) {
    const std::string_view name = authority.substr(
        0, authority.starts_with('[') ? std::min(authority.find(']'), authority.size() - 1) + 1
                                      : authority.rfind(':'));
    return name == "localhost" || name == "[::1]" ||
           (name.starts_with("127.") && name.find_first_not_of("0123456789.") == std::string_view::npos);
  };
  if (!names_here(host)) return false;
  if (origin.empty() || origin == "https://app.foxglove.dev" || origin == "https://app.foxglove.com")
    return true;
  const std::size_t scheme = origin.find("://");
  if (scheme == std::string_view::npos) return false;
  const bool is_site = origin.starts_with("http://") || origin.starts_with("https://");
  return !is_site || names_here(origin.substr(scheme + 3));
}

}  // namespace karst::live
