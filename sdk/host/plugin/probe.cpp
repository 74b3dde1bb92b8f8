#include "sdk/host/plugin/probe.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core_stack/common/format_text.h"
#include "core_stack/common/json_text.h"
#include "sdk/host/boundary/text.h"
#include "sdk/host/plugin/parameters.h"
#include "sdk/host/plugin/plugin_file.h"

namespace karst::host {
namespace {

using nlohmann::json;

std::string line_of(const karst_text_t& t) { return cleaned(t, kLogLineLimit); }

std::string default_text(const karst_parameter_t& p) {
  if (p.type == KARST_PARAMETER_BOOLEAN) return p.default_number != 0 ? "true" : "false";
  if (p.type == KARST_PARAMETER_TEXT) return line_of(p.default_text);
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, p.default_number).ptr};
}

json parameter_json(const karst_parameter_t& p) {
  return {{"id", line_of(p.id)},
          {"type", core::name_of(static_cast<ParameterType>(p.type))},
          {"unit", line_of(p.unit)},
          {"default", default_text(p)},
          {"low", p.low},
          {"high", p.high},
          {"help", line_of(p.help)},
          {"choices", split_choices(line_of(p.choices))}};
}

json policy_json(const karst_policy_descriptor_t& d) {
  json parameters = json::array();
  for (std::uint32_t i = 0; i < d.parameter_count; ++i) parameters.push_back(parameter_json(d.parameters[i]));
  return {{"id", line_of(d.id)},
          {"name", line_of(d.name)},
          {"version", line_of(d.version)},
          {"one_line", line_of(d.one_line)},
          {"parameters", parameters}};
}

/// In the child: the answer as JSON.
std::string answer(const std::string& file) {
  try {
    const PluginFile plugin = open_plugin(file);
    json out = json::array();
    for (const karst_policy_t* p : plugin.policies) out.push_back(policy_json(*p->descriptor));
    const std::string abi =
        std::to_string(plugin.plugin->abi_major) + "." + std::to_string(plugin.plugin->abi_minor);
    return core::json_text(json{{"abi", abi}, {"policies", out}});
  } catch (const std::exception& e) {
    std::string reason = e.what();
    if (reason.rfind(file + ": ", 0) == 0) reason.erase(0, file.size() + 2);
    return core::json_text(json{{"broken", reason}});
  }
}

PolicyListing from_json(const std::string& file, const std::string& abi, const json& j) {
  PolicyListing p;
  p.file = file;
  p.abi = abi;
  p.id = j.at("id");
  p.name = j.at("name");
  p.version = j.at("version");
  p.one_line = j.at("one_line");
  for (const json& q : j.at("parameters"))
    p.parameters.push_back({q.at("id"), core::parse<ParameterType>(q.at("type").get<std::string>()).value(),
                            q.at("unit"), q.at("default"), q.at("help"),
                            q.at("low").is_number() ? q.at("low").get<double>() : 0.0,
                            q.at("high").is_number() ? q.at("high").get<double>() : 0.0, q.at("choices")});
  return p;
}

[[noreturn]] void run_child(const std::string& file, int out) {
  setpgid(0, 0);  // with all that it may start
  const int null = open("/dev/null", O_RDWR);
  dup2(null, STDIN_FILENO);
  dup2(null, STDOUT_FILENO);
  dup2(null, STDERR_FILENO);
  const std::string text = answer(file);
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t n = ::write(out, text.data() + sent, text.size() - sent);
    if (n <= 0) break;
    sent += static_cast<std::size_t>(n);
  }
  _exit(0);
}

/// Enough for 64 policies with 256 parameters each and five texts of a kilobyte for each parameter.
constexpr std::size_t kMaxBytes = std::size_t{128} << 20;

/// Reads until the other end closes. False if that takes longer than the limit, or exceeds kMaxBytes.
bool read_all(int in, double limit_s, std::string& text) {
  using clock = std::chrono::steady_clock;
  const auto until = clock::now() + std::chrono::duration<double>(limit_s);
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - clock::now()).count();
    pollfd waiting{in, POLLIN, 0};
    const int ready = left <= 0 ? 0 : poll(&waiting, 1, static_cast<int>(left));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return false;
    char buffer[4096];
    const ssize_t n = read(in, buffer, sizeof buffer);
    if (n <= 0) return true;
    if (text.size() > kMaxBytes) return false;
    text.append(buffer, static_cast<std::size_t>(n));
  }
}

std::vector<PolicyListing> broken(const std::string& file, const std::string& reason) {
  PolicyListing p;
  p.file = file;
  p.broken = reason;
  return {p};
}

}  // namespace

std::vector<PolicyListing> probe(const std::string& file, double limit_s) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    return broken(file, std::string("cannot be probed: ") + std::strerror(errno));
  const pid_t child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    return broken(file, std::string("cannot be probed: ") + std::strerror(errno));
  }
  if (child == 0) run_child(file, ends[1]);
  close(ends[1]);
  std::string text;
  const bool in_time = read_all(ends[0], limit_s, text);
  close(ends[0]);
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  kill(-child, SIGKILL);  // what it left behind
  if (!in_time)
    return broken(file,
                  core::format_text("did not say what it is in time (%g s): opening it hangs", limit_s));
  if (WIFSIGNALED(status))
    return broken(file, std::string("crashes when opened: ") + strsignal(WTERMSIG(status)));
  const json said = core::json_of(text);
  if (!said.is_object()) return broken(file, "ended the process when opened");
  try {  // the plugin may have written it
    if (said.contains("broken")) return broken(file, said.at("broken"));
    std::vector<PolicyListing> out;
    for (const json& j : said.at("policies")) out.push_back(from_json(file, said.at("abi"), j));
    return out;
  } catch (const std::exception&) {
    return broken(file, "wrote to files that it had not opened");
  }
}

}  // namespace karst::host
