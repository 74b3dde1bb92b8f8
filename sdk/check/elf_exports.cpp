#include "sdk/check/elf_exports.h"

#include <elf.h>

#include <cstring>
#include <fstream>
#include <iterator>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::check {
namespace {

/// Copies a struct from the file with bounds checks: the file's own offsets are not trusted.
template <class T>
T at(const std::string& bytes, std::uint64_t offset, const std::string& file) {
  if (offset > bytes.size() || bytes.size() - offset < sizeof(T))
    throw core::InputError(file, "", "is cut short");
  T out;
  std::memcpy(&out, bytes.data() + offset, sizeof out);
  return out;
}

}  // namespace

std::vector<std::string> exported_symbols(const std::string& file) {
  const std::string bytes = core::read_input(file, core::kMaxPluginBytes);
  const auto header = at<Elf64_Ehdr>(bytes, 0, file);
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_ident[EI_CLASS] != ELFCLASS64)
    throw core::InputError(file, "", "is not a 64-bit ELF file");
  const auto section = [&](std::uint64_t i) {
    return at<Elf64_Shdr>(bytes, header.e_shoff + i * sizeof(Elf64_Shdr), file);
  };
  std::vector<std::string> names;
  for (std::uint64_t i = 0; i < header.e_shnum; ++i) {
    const Elf64_Shdr table = section(i);
    if (table.sh_type != SHT_DYNSYM) continue;
    const Elf64_Shdr texts = section(table.sh_link);
    for (std::uint64_t k = 0; k < table.sh_size / sizeof(Elf64_Sym); ++k) {
      const auto symbol = at<Elf64_Sym>(bytes, table.sh_offset + k * sizeof(Elf64_Sym), file);
      const unsigned visibility = ELF64_ST_VISIBILITY(symbol.st_other);
      const bool hidden = visibility == STV_HIDDEN || visibility == STV_INTERNAL;
      if (symbol.st_shndx == SHN_UNDEF || hidden || ELF64_ST_BIND(symbol.st_info) == STB_LOCAL) continue;
      const std::uint64_t name = texts.sh_offset + symbol.st_name;
      if (name >= bytes.size()) throw core::InputError(file, "", "is cut short");
      names.emplace_back(bytes.data() + name, strnlen(bytes.data() + name, bytes.size() - name));
    }
    return names;
  }
  throw core::InputError(file, "", "has no table of dynamic symbols");
}

}  // namespace karst::check
