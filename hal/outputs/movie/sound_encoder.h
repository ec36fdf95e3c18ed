#pragma once

#include <memory>

#include "hal/outputs/movie/sound_source.h"

namespace pleinair::hal::movie {

/// `sound` decoded, and coded anew as AAC, in step with it; null where libav has no decoder for it
/// or no encoder.
std::unique_ptr<SoundSource> recodeSound(std::unique_ptr<SoundSource> sound);

}  // namespace pleinair::hal::movie
