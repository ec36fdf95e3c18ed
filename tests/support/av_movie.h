#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "hal/clock.h"
#include "hal/media/handles.h"
#include "hal/pixel_format.h"

namespace pleinair::support {

/// A movie as other programs write them: with colours, pixel shapes and sound that the program's
/// own outputs do not have.
struct AvMovie {
  AVCodecID coding = AV_CODEC_ID_FFV1;  ///< lossless; in .mkv
  AVPixelFormat layout = AV_PIX_FMT_YUV420P;
  hal::FrameSize size{64, 48};
  int frames = 25;
  int framesPerSecond = 25;
  AVRational pixelAspect{1, 1};
  AVColorPrimaries primaries = AVCOL_PRI_BT709;
  AVColorTransferCharacteristic transfer = AVCOL_TRC_BT709;
  AVColorSpace matrix = AVCOL_SPC_BT709;
  /// Fills a frame; null: a grey that grows from frame to frame.
  std::function<void(AVFrame& frame, int number)> draw = nullptr;
  /// Of 48 kHz, one channel, silent but for a click at these times; AV_CODEC_ID_NONE: no sound.
  AVCodecID soundCoding = AV_CODEC_ID_NONE;
  std::vector<double> clicksSeconds = {};
};

/// Throws std::runtime_error where libav refuses.
void writeAvMovie(const std::filesystem::path& path, const AvMovie& movie);

/// The times of the clicks in a movie's sound, on the time of its first video frame, as libav's own
/// decoders give them; nothing without sound.
std::optional<std::vector<double>> clicksIn(const std::filesystem::path& path);

}  // namespace pleinair::support
