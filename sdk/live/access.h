// Where a flight is served, and who may follow it.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace karst::live {

struct Endpoint {
  std::string address = "127.0.0.1";  // a number, no name
  std::uint16_t port = 8765;          // 0: the system chooses one
};

/// "ADDRESS:PORT", "ADDRESS", ":PORT" or ""; an IPv6 address in brackets. Throws core::InputError naming
/// `option`.
Endpoint endpoint_of(const std::string& text, const std::string& option);
/// Of this machine alone: 127.0.0.0/8, ::1.
bool is_loopback(const Endpoint& endpoint);
/// "127.0.0.1:8765", "[::1]:8765".
std::string text_of(const Endpoint& endpoint);

/// At least 8 characters that a URL may hold as they are: letters, digits and -._~
bool is_token(std::string_view text);
/// The token that a request gives: in its target, "/?token=...", else in the header Authorization, "Bearer
/// ..."; "" if there is none.
std::string_view token_of(std::string_view target, std::string_view authorization);
/// In a time that tells nothing of where they differ.
bool same_token(std::string_view given, std::string_view expected);

/// Whether a request without a token may follow the flight: it was sent to this machine by name or number,
/// and not by a page of another site, whose browser names it as the origin. Foxglove's site may, and so may
/// applications, whose origins are no sites.
bool is_from_here(std::string_view host, std::string_view origin);

}  // namespace karst::live
