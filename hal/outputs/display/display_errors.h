#pragma once

#include <string>

#include "hal/error.h"

namespace pleinair::hal::display {

/// kNotFound: the machine has no graphics card that shows pictures.
Error noCard(std::string subject);
/// kBusy: another program is the card's master; names those that have it open.
Error notMaster(const std::string& node, std::string subject);

}  // namespace pleinair::hal::display
