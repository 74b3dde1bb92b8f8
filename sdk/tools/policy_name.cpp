#include "sdk/tools/policy_name.h"

#include <algorithm>
#include <string_view>

#include "sdk/host/plugin/discovery.h"

namespace karst::tools {
namespace {

/// Words that cannot name a class, file or target: the keywords of C++20, and the targets that CMake creates
/// itself.
constexpr std::string_view kReserved =
    " alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t char32_t "
    "class "
    "compl concept const const_cast consteval constexpr constinit continue co_await co_return co_yield "
    "decltype "
    "default delete do double dynamic_cast else enum explicit export extern false float for friend goto if "
    "inline "
    "int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public "
    "register "
    "reinterpret_cast requires return short signed sizeof static static_assert static_cast struct switch "
    "template "
    "this thread_local throw true try typedef typeid typename union unsigned using virtual void volatile "
    "wchar_t "
    "while xor xor_eq "
    "all clean depend edit_cache help install list_install_components package package_source rebuild_cache "
    "test ";
/// Words that cannot name a module of Python (its keywords that `kReserved` lacks), and the modules that a
/// policy and its test import.
constexpr std::string_view kNoModule =
    " as assert async await def del elif except finally from global import in is lambda nonlocal pass raise "
    "with "
    "yield karst numpy ";
constexpr std::size_t kLongest = 64;

bool is_small(char c) { return c >= 'a' && c <= 'z'; }
bool is_allowed(char c) { return is_small(c) || (c >= '0' && c <= '9') || c == '_'; }

}  // namespace

std::string name_fault(const std::string& name) {
  if (name.empty() || !is_small(name[0]) || !std::all_of(name.begin(), name.end(), is_allowed))
    return "a policy's name is small letters, digits and underscores, and begins with a letter: "
           "[a-z][a-z0-9_]*";
  if (name.size() > kLongest) return "a policy's name has at most 64 characters";
  if (kReserved.find(" " + name + " ") != std::string_view::npos)
    return "is a word of C++ or of CMake; choose another name";
  for (const host::PolicyListing& p : host::list_policies(host::default_search_path()))
    if (p.broken.empty() && p.id == name) return "a policy of this name is there already: " + p.file;
  return "";
}

std::string module_name_fault(const std::string& name) {
  if (kNoModule.find(" " + name + " ") == std::string_view::npos) return "";
  return "is a word of Python, or a module that the policy needs; choose another name";
}

std::string class_name(const std::string& name) {
  std::string out;
  bool first = true;
  for (const char c : name) {
    if (c != '_') out += first && is_small(c) ? static_cast<char>(c - 'a' + 'A') : c;
    first = c == '_';
  }
  return out;
}

}  // namespace karst::tools
