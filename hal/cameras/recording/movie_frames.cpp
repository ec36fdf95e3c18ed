#include "hal/cameras/recording/movie_frames.h"

#include <chrono>
#include <utility>
#include <variant>

#include "hal/cameras/recording/frame_source.h"
#include "hal/cameras/recording/recording.h"
#include "hal/cameras/recording/timeline.h"
#include "hal/media/frame_pixels.h"

namespace pleinair::hal {
namespace {

constexpr Duration kUsualPeriod = std::chrono::milliseconds(40);  // of a movie that says none
/// Ten seconds of a usual movie, and many times what any decoder keeps back.
constexpr int kMostWithoutFrame = 250;

}  // namespace

Result<void> forMovieFrames(const std::filesystem::path& movie, Duration from,
                            const TakeMovieFrame& take, const std::function<bool()>& isUnwanted) {
  auto source = recording::openMovie(
      movie, {.from = from}, {.mostWithoutFrame = kMostWithoutFrame, .isUnwanted = isUnwanted});
  if (!source) return tl::unexpected(source.error());
  recording::Timeline timeline((*source)->framePeriod().value_or(kUsualPeriod));
  bool isAnyTaken = false;
  for (;;) {
    recording::SourceItem item = (*source)->next();
    if (auto* error = std::get_if<Error>(&item)) {
      if (isAnyTaken) return {};
      return tl::unexpected(std::move(*error));
    }
    if (std::holds_alternative<recording::SourceEnd>(item)) {
      if (isAnyTaken || (isUnwanted && isUnwanted())) return {};
      return tl::unexpected(Error{.kind = ErrorKind::kInvalidInput,
                                  .subject = movie.string(),
                                  .problem = "has no valid frame",
                                  .remedy = "give another movie"});
    }
    const auto& frame = std::get<recording::SourceFrame>(item);
    auto picture = libav::lendPicture(frame.frame, libav::Delivery::kRgb);
    if (!picture) {
      if (isAnyTaken) return {};
      picture.error().subject = movie.string();
      return tl::unexpected(std::move(picture.error()));
    }
    isAnyTaken = true;
    if (!take(picture->view, timeline.place(frame.time, frame.droppedBefore))) return {};
  }
}

}  // namespace pleinair::hal
