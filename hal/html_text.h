#pragma once

#include <string>
#include <string_view>

namespace pleinair::hal {

/// `text` as HTML has it, for text and for values of attributes in double quotes: names of devices
/// and files may hold any characters.
std::string htmlText(std::string_view text);

}  // namespace pleinair::hal
