#pragma once

#include <string>
#include <string_view>

namespace pleinair::hal {

/// A name that a device gives itself, with "?" for control characters, which would end a line or
/// command a terminal. UTF-8 stays.
std::string printable(std::string_view text);

}  // namespace pleinair::hal
