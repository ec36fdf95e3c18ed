#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "pipeline/gpu/gl.h"
#include "pipeline/gpu/handle.h"

namespace pleinair::gpu {

/// How a buffer is used, as GL's hint.
enum class BufferUsage { kStatic, kDynamic, kReadBack };

/// The size of glDrawArraysIndirect's command (shaders/draw_command.glsl).
inline constexpr std::size_t kDrawCommandBytes = 16;

/// A buffer of fixed size: storage, vertices, indices or read-back. Belongs to the context it was
/// made in.
class Buffer {
 public:
  Buffer() = default;
  /// Undefined content. Precondition: sizeBytes > 0. Throws hal::Failure (kUnsupported) where
  /// the GPU has no memory for it.
  Buffer(std::size_t sizeBytes, BufferUsage usage);
  /// Holds a copy of `items`, which must be trivially copyable.
  template <class T>
  static Buffer of(std::span<const T> items, BufferUsage usage = BufferUsage::kStatic) {
    static_assert(std::is_trivially_copyable_v<T>);
    Buffer buffer(items.size_bytes(), usage);
    buffer.write(std::as_bytes(items));
    return buffer;
  }

  void write(std::span<const std::byte> bytes, std::size_t offsetBytes = 0);
  /// Waits for the GPU and reads the buffer's beginning. False, with nothing read, where it cannot
  /// be mapped: the GPU is lost. Never in the frame's way: for measures and tests.
  bool read(std::span<std::byte> bytes) const;
  std::size_t sizeBytes() const { return sizeBytes_; }
  GLuint name() const { return handle_.get(); }
  explicit operator bool() const { return static_cast<bool>(handle_); }

 private:
  BufferHandle handle_;
  std::size_t sizeBytes_ = 0;
};

}  // namespace pleinair::gpu
