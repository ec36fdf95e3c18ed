#include "pipeline/gpu/buffer.h"

#include <cassert>
#include <cstring>

#include <fmt/format.h>

#include "pipeline/gpu/gpu_memory.h"

namespace pleinair::gpu {
namespace {

GLenum glUsage(BufferUsage usage) {
  switch (usage) {
    case BufferUsage::kStatic:
      return GL_STATIC_DRAW;
    case BufferUsage::kDynamic:
      return GL_DYNAMIC_COPY;
    case BufferUsage::kReadBack:
      return GL_STREAM_READ;
  }
  return GL_STATIC_DRAW;
}

}  // namespace

Buffer::Buffer(std::size_t sizeBytes, BufferUsage usage)
    : handle_(BufferHandle::make()), sizeBytes_(sizeBytes) {
  assert(sizeBytes > 0);
  glBindBuffer(GL_COPY_WRITE_BUFFER, handle_.get());
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(sizeBytes), nullptr, glUsage(usage));
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
  checkMemory(fmt::format("a buffer of {} bytes", sizeBytes));
}

void Buffer::write(std::span<const std::byte> bytes, std::size_t offsetBytes) {
  assert(offsetBytes + bytes.size() <= sizeBytes_);
  glBindBuffer(GL_COPY_WRITE_BUFFER, handle_.get());
  glBufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offsetBytes),
                  static_cast<GLsizeiptr>(bytes.size()), bytes.data());
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

bool Buffer::read(std::span<std::byte> bytes) const {
  assert(bytes.size() <= sizeBytes_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_READ_BUFFER, handle_.get());
  const void* mapped = glMapBufferRange(GL_COPY_READ_BUFFER, 0,
                                        static_cast<GLsizeiptr>(bytes.size()), GL_MAP_READ_BIT);
  if (mapped != nullptr) {
    std::memcpy(bytes.data(), mapped, bytes.size());
    glUnmapBuffer(GL_COPY_READ_BUFFER);
  }
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  return mapped != nullptr;
}

}  // namespace pleinair::gpu
