#pragma once

#include <span>
#include <string>

namespace pleinair::app {

/// The words as a POSIX shell reads them back, each in single quotes where it needs some.
std::string shellText(std::span<const std::string> words);

}  // namespace pleinair::app
