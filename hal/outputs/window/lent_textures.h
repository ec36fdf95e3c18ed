#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <SDL.h>

#include "hal/image.h"
#include "hal/surface.h"

namespace pleinair::hal::window {

/// Textures of a renderer that a painter draws into, in a context of its own on the renderer's EGL
/// display. The two contexts share nothing but these, so that each may have its own answer to
/// resets. One is seen while others are free, in the painter's hands, or wait until the renderer's
/// GPU has drawn the window from them for the last time. On SDL's thread; the renderer outlives it.
class LentTextures {
 public:
  LentTextures() = default;
  LentTextures(const LentTextures&) = delete;
  LentTextures& operator=(const LentTextures&) = delete;
  ~LentTextures();

  /// The EGLDisplay of a renderer that has drawn, and may share textures with other contexts.
  /// Error: kUnsupported (why it shares none; it is software, which is not wanted).
  static Result<void*> displayOf(SDL_Renderer* renderer, bool mayBeSoftware);

  /// Makes so many textures of this size, in place of earlier ones, of which the one that is seen
  /// stays. Errors: kUnsupported, kNoSpace.
  Result<std::vector<GpuSurface>> lend(SDL_Renderer* renderer, FrameSize size, std::size_t count);
  /// All of them, and what is seen, go.
  void clear();
  /// A free one, which belongs to the painter from here on.
  std::optional<SurfaceId> acquire();
  /// Waits for the GPU. RGBA8.
  Result<Image> copy(SDL_Renderer* renderer, SurfaceId surface);

  /// From the next drawing on, this one is seen; it was acquired.
  void show(SurfaceId surface);
  /// From the next drawing on, none of them is.
  void hide();
  /// The window was drawn: what it showed before is free once the GPU is done.
  void drawn();
  /// Null: none of them.
  SDL_Texture* seen() const { return seen_.get(); }
  bool isSeen(SurfaceId surface) const {
    const auto index = static_cast<std::size_t>(surface);
    return index < lent_.size() && lent_[index].state == State::kSeen;
  }

 private:
  enum class State { kFree, kAcquired, kSeen, kReplaced, kLeaving };
  struct Lent {
    std::shared_ptr<SDL_Texture> texture;
    std::uint32_t name = 0;  ///< GL's
    State state = State::kFree;
    void* done = nullptr;  ///< EGLSync, of kLeaving
  };
  Result<GpuSurface> make(SDL_Renderer* renderer, FrameSize size, SurfaceId id);
  bool hasLeft(Lent& lent) const;
  void forgetSync(Lent& lent) const;

  void* display_ = nullptr;
  bool hasFences_ = false;
  FrameSize size_;
  std::vector<Lent> lent_;             ///< by their ids
  std::shared_ptr<SDL_Texture> seen_;  ///< may be of an earlier loan
};

}  // namespace pleinair::hal::window
