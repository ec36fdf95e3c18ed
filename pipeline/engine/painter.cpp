#include "pipeline/engine/painter.h"

#include <functional>
#include <optional>
#include <utility>

#include "hal/error.h"
#include "pipeline/engine/frame_pipeline.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/host_state.h"
#include "pipeline/gpu/render_thread.h"

namespace pleinair {
namespace {

void checkSize(hal::FrameSize size) {
  if (hal::isAcceptedSize(size)) return;
  throw hal::Failure(
      hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                 .subject = "picture size",
                 .problem = std::to_string(size.width) + "x" + std::to_string(size.height),
                 .remedy = "at least 1 px, at most " + std::to_string(hal::kMaxSidePixels) +
                           " px a side and " + std::to_string(hal::kMaxPixels / 1'000'000) +
                           " Mpx are allowed"});
}

}  // namespace

struct Painter::Impl {
  std::optional<gpu::RenderThread> thread;    // with kOwn only
  std::optional<gpu::EglContext> ownContext;  // lives and dies on the thread
  gpu::ContextInfo contextInfo;
  std::optional<FramePipeline> chain;

  explicit Impl(const PainterOptions& options) {
    checkSize(options.pictureSize);
    if (options.context == PainterContext::kOwn) {
      thread.emplace("painter");
    } else {
      contextInfo = gpu::inspectCurrentContext("host");
    }
    try {
      run([&] { build(options); });
    } catch (...) {
      run([&] { tearDown(); });
      throw;
    }
  }
  ~Impl() {
    run([&] { tearDown(); });
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void build(const PainterOptions& options) {
    if (thread) {
      ownContext.emplace();
      contextInfo = ownContext->info();
    }
    chain.emplace(options, contextInfo);
  }

  bool isLost() const { return chain && chain->loss(); }

  /// A lost context's objects go with it; nothing more is asked of its driver than that.
  void tearDown() {
    {
      std::optional<gpu::ContextLossGuard> abandon;
      if (isLost()) abandon.emplace();
      chain.reset();
    }
    ownContext.reset();
  }

  void run(const std::function<void()>& task) {
    if (thread) {
      thread->run(task);
    } else if (isLost()) {
      task();  // the host's context may be another one by now: it stays as it is
    } else {
      const gpu::HostState state;
      task();
    }
  }

  /// What `task` returns, from the context's thread.
  template <class Task>
  auto call(Task task) {
    std::optional<decltype(task())> result;
    run([&] { result.emplace(task()); });
    return std::move(*result);
  }
};

Painter::Painter(const PainterOptions& options) : impl_(std::make_unique<Impl>(options)) {}

Painter::~Painter() = default;

const gpu::ContextInfo& Painter::contextInfo() const {
  return impl_->contextInfo;
}

PaintParameters Painter::defaultParameters() const {
  return impl_->chain->defaultParameters();
}

std::vector<DebugView> Painter::views() const {
  return impl_->chain->views();
}

std::vector<PainterLook> Painter::looks() const {
  return impl_->chain->looks();
}

config::ParameterValues Painter::lookParameters(std::string_view look) const {
  return impl_->chain->lookParameters(look);
}

hal::Result<Picture> Painter::paint(const hal::CapturedFrame& frame,
                                    const PaintParameters& parameters) {
  return impl_->call([&] { return impl_->chain->paint(frame, parameters); });
}

int Painter::openReadback(const hal::FrameFormat& format) {
  return impl_->call([&] { return impl_->chain->openReadback(format); });
}

hal::Result<bool> Painter::take(int reader, OutputFrame& picture, bool wait) {
  return impl_->call([&] { return impl_->chain->take(reader, picture, wait); });
}

bool Painter::hasRoom(int reader) const {
  return impl_->chain->hasRoom(reader);
}

std::uint64_t Painter::skipped(int reader) const {
  return impl_->chain->skipped(reader);
}

hal::Result<hal::Image> Painter::snapshot() const {
  return impl_->call([&] { return impl_->chain->snapshot(); });
}

hal::Result<hal::Image> Painter::cameraSnapshot() const {
  return impl_->call([&] { return impl_->chain->cameraSnapshot(); });
}

hal::Result<std::vector<marks::Anchor>> Painter::anchors() const {
  return impl_->call([&] { return impl_->chain->anchors(); });
}

void Painter::reset() {
  impl_->run([&] { impl_->chain->reset(); });
}

std::vector<gpu::PassTime> Painter::passTimes() const {
  return impl_->chain->passTimes();
}

}  // namespace pleinair
