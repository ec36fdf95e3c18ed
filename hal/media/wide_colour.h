#pragma once

#include "hal/error.h"
#include "hal/media/handles.h"
#include "hal/pixel_format.h"

namespace pleinair::hal::libav {

/// Whether a frame holds what 8-bit sRGB does not: HDR (PQ or HLG), a wider gamut (BT.2020,
/// Display P3, DCI-P3), or more than 8 bits a channel. Frames with alpha never do: they are
/// composited in 8 bits.
bool isWideColour(const AVFrame& frame);

/// The frame as RGB24 of `size`, in sRGB primaries, by zimg. HDR is tone-mapped (ToneCurve): its
/// peak is the one of the frame's side data (MaxCLL, else the mastering display's), else 1000
/// cd/m². Wider gamuts are converted, and what lies outside is clipped (HDR: see ToneCurve). More
/// than 8 bits end in an ordered dither, which keeps their local mean. Errors: kUnsupported (a
/// colour space that zimg does not know). Throws std::bad_alloc. Precondition: isWideColour().
Result<Frame> toSrgb(const AVFrame& frame, FrameSize size);

}  // namespace pleinair::hal::libav
