#pragma once

#include <optional>
#include <string_view>

#include "hal/cameras/synthetic/render/shot.h"
#include "hal/error.h"

namespace pleinair::hal {

/// The shot that a camera's name on the command line means: "synthetic" (the walkaround) or
/// "synthetic:SHOT". Nothing where the name is not the synthetic camera's at all. Errors:
/// kInvalidArgument (unknown shot), with the shots there are; its subject is `subject`, such as
/// "--camera".
Result<std::optional<SyntheticShot>> syntheticShotOf(std::string_view camera,
                                                     std::string_view subject);

}  // namespace pleinair::hal
