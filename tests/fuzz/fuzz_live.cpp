// What a client of a live flight sends: its requests, the token of its address, the subprotocols that it
// offers; and the address of --live.
#include <array>
#include <cstdint>
#include <cstdlib>

#include "core_stack/common/error.h"
#include "sdk/live/access.h"
#include "sdk/live/client_session.h"

using namespace karst::live;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  Retained retained(
      {{"/stream", {}, Keeping::none}, {"/map", {}, Keeping::whole}, {"/new", {}, Keeping::since_latest_map}},
      1);
  ClientSession session(retained, "{}");
  for (std::size_t begin = 0; begin <= size;) {  // a request a line, and messages between them
    const std::size_t end = std::min(text.find('\n', begin), size);
    session.receive(std::string_view(text).substr(begin, end - begin));
    const LiveMessage message{begin % 3, begin, std::make_shared<const std::string>(end - begin, 'x')};
    retained.keep(message);
    session.publish(message);
    begin = end + 1;
  }
  if (session.subscriptions() > 3 || session.waiting_bytes() > Outbox::kMaxBytes) std::abort();
  session.tell_dropped();
  std::size_t frames = 0;
  while (session.next())
    if (++frames > ClientSession::kMaxTexts + 3 * Outbox::kMaxMessages + 2) std::abort();
  if (!session.idle()) std::abort();

  const std::string_view token = token_of(text, text);
  if (same_token(token, "a.long-token") != (token == "a.long-token")) std::abort();
  chosen_subprotocol(text);
  try {
    const Endpoint endpoint = endpoint_of(text, "--live");
    if (text_of(endpoint_of(text_of(endpoint), "--live")) != text_of(endpoint)) std::abort();
  } catch (const karst::core::InputError&) {
  }
  return 0;
}
