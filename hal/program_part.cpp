#include "hal/program_part.h"

#include <system_error>

namespace pleinair::hal {

std::filesystem::path programPart(std::string_view name) {
  std::error_code error;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  for (const char* const folder : {".", "../libexec/pleinair"}) {
    std::filesystem::path path = own.parent_path() / folder / name;
    if (std::filesystem::exists(path, error)) return path;
  }
  return {};
}

}  // namespace pleinair::hal
