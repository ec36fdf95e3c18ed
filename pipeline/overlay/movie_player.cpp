#include "pipeline/overlay/movie_player.h"

#include <algorithm>
#include <cassert>

namespace pleinair::overlay {

std::size_t frameAt(const PanelMovie& movie, hal::Duration sinceItBegan) {
  // A recording that is played again, or a clock that was set, may lie before the beginning.
  const hal::Duration time = std::max(sinceItBegan, hal::Duration::zero()) % movie.length;
  const auto next = std::ranges::upper_bound(movie.frames, time, {}, &PanelMovie::Frame::begins);
  return static_cast<std::size_t>(next - movie.frames.begin()) - 1;
}

void MoviePlayer::take(const std::shared_ptr<const PanelMovie>& movie) {
  if (movie == movie_) return;
  movie_ = movie;
  began_.reset();
  uploaded_.reset();
  if (!movie_) {
    texture_ = {};
    return;
  }
  assert(!movie_->frames.empty() && movie_->length > movie_->frames.back().begins);
  const hal::FrameSize size = movie_->frames.front().image.size();
  if (texture_.size() == size) return;
  texture_ = gpu::Texture(gpu::TextureFormat::kRgb8, size, gpu::TextureFilter::kLinear);
}

const gpu::Texture& MoviePlayer::at(hal::TimePoint now) {
  assert(movie_ != nullptr);
  if (!began_) began_ = now;
  const std::size_t frame = frameAt(*movie_, now - *began_);
  if (uploaded_ != frame) {
    const hal::ImageView view = movie_->frames[frame].image.view();
    texture_.upload(view.planes[0].bytes, view.planes[0].strideBytes);
    uploaded_ = frame;
  }
  return texture_;
}

}  // namespace pleinair::overlay
