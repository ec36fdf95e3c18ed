#pragma once

#include <filesystem>
#include <string_view>

namespace pleinair::hal {

/// The path of a file that belongs to this program: in its own folder, as where it was built, or in
/// ../libexec/pleinair, as where it is installed. Empty where it is in neither.
std::filesystem::path programPart(std::string_view name);

}  // namespace pleinair::hal
