#include "sdk/tools/help/man_pages.h"

#include <sstream>

namespace karst::tools {
namespace {

/// A line of text: roff reads a backslash, a hyphen, and a full stop or an apostrophe in front.
std::string roff_line(const std::string& text) {
  std::string out = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

/// Text of several lines: what is indented, such as examples and tables, stays as it is.
std::string roff_text(const std::string& text) {
  std::istringstream in(text);
  std::string out;
  bool literal = false, broken = true;  // broken: a new line begins anyway
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("  ") != literal) {
      literal = !literal;
      out += literal ? ".PP\n.nf\n" : ".fi\n.PP\n";
      broken = true;
    }
    if (line.empty()) {
      if (!broken) out += ".PP\n";
      broken = true;
      continue;
    }
    if (!literal && !broken) out += ".br\n";
    broken = false;
    out += roff_line(line) + "\n";
  }
  return out + (literal ? ".fi\n" : "");
}

std::string bold(const std::string& text) { return "\\fB" + roff_line(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff_line(text) + "\\fR"; }

std::string page_name(const std::vector<std::string>& words) { return joined(words, "-"); }
std::string reference(const std::vector<std::string>& words) { return bold(page_name(words)) + "(1)"; }

std::string synopsis(const Command& command) {
  std::string out = bold(joined(command.words)) + " [" + italic("OPTIONS") + "]";
  for (const CommandOption& a : command.arguments) {
    const std::string name = italic(a.argument) + (a.repeats ? " ..." : "");
    out += a.required ? " " + name : " [" + name + "]";
  }
  if (!command.below.empty()) out += " " + italic("COMMAND");
  return out;
}

std::string entry(const CommandOption& option) {
  std::string head = italic(option.argument);
  if (!option.names.empty()) {
    head.clear();
    for (const std::string& name : option.names) head += (head.empty() ? "" : ", ") + bold(name);
  }
  if (!option.names.empty() && option.kind != ValueKind::none) head += " " + italic(option.value);
  std::string help = option.help;
  const auto append = [&help](const std::string& sentence) {
    help += help.empty() || help.ends_with('.') ? "" : ".";
    help += "\n" + sentence;
  };
  if (option.kind == ValueKind::choice) append("One of " + joined(option.choices, ", ") + ".");
  if (!option.default_text.empty()) append("Default: " + option.default_text + ".");
  if (option.required) append("Required.");
  return ".TP\n" + head + "\n" + roff_text(help);
}

std::string section(const std::string& title, const std::vector<CommandOption>& options) {
  std::string out = options.empty() ? "" : ".SH " + title + "\n";
  for (const CommandOption& option : options) out += entry(option);
  return out;
}

std::vector<std::string> words_below(const Command& group, const std::string& name) {
  std::vector<std::string> words = group.words;
  words.push_back(name);
  return words;
}

std::string see_also(const Command& command) {
  std::vector<std::string> references;
  if (command.words.size() > 1)
    references.push_back(reference({command.words.begin(), command.words.end() - 1}));
  for (const std::string& name : command.below) references.push_back(reference(words_below(command, name)));
  return references.empty() ? "" : ".SH SEE ALSO\n" + joined(references, ",\n") + "\n";
}

/// `text` with `other` for each `part`.
std::string with_instead(std::string text, const std::string& part, const std::string& other) {
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + other.size()))
    text.replace(at, part.size(), other);
  return text;
}

std::string files(const std::string& doc_folder) {
  return ".SH FILES\n.TP\n" + italic(doc_folder) + "\nDocumentation and examples.\n";
}

std::string page(const Command& command, const std::vector<Command>& all, const std::string& version,
                 const DocFolders& doc) {
  const std::string name = roff_line(page_name(command.words));
  std::string out = ".TH \"" + name + "\" 1 \"\" \"karst " + roff_line(version) + "\" \"karst\"\n";
  out += ".SH NAME\n" + name + " \\- " + roff_line(command.summary) + "\n";
  out += ".SH SYNOPSIS\n" + synopsis(command) + "\n";
  if (!command.details.empty()) out += ".SH DESCRIPTION\n" + roff_text(command.details);
  out += section("ARGUMENTS", command.arguments) + section("OPTIONS", command.options);
  if (!command.below.empty()) out += ".SH COMMANDS\n";
  for (const std::string& part : command.below)
    for (const Command& c : all)
      if (c.words == words_below(command, part))
        out += ".TP\n" + bold(joined(c.words)) + "\n" + roff_line(c.summary) + "\n";
  return with_instead(out, roff_line(doc.here + "/"), roff_line(doc.of_reader + "/")) + files(doc.of_reader) +
         see_also(command);
}

}  // namespace

std::map<std::string, std::string> man_pages(const std::vector<Command>& commands, const std::string& version,
                                             const DocFolders& doc) {
  std::map<std::string, std::string> pages;
  for (const Command& command : commands)
    pages[page_name(command.words) + ".1"] = page(command, commands, version, doc);
  return pages;
}

}  // namespace karst::tools
