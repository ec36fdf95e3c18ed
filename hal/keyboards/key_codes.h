#pragma once

#include <string>

namespace pleinair::hal::keyboards {

enum class Modifier { kNone, kShift, kOther };  ///< kOther: Control, Alt, the logo key

/// What a KEY_… of linux/input-event-codes.h modifies.
Modifier modifierOf(unsigned code);

/// KeyPressed::name of a key, by its place on a US keyboard; empty where it has none.
std::string keyNameOf(unsigned code, bool shift);

}  // namespace pleinair::hal::keyboards
