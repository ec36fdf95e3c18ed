#pragma once

#include "tests/support/needs_gpu.h"

namespace pleinair {

class OverlayTest : public support::NeedsGpu {};

}  // namespace pleinair
