#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include <dlfcn.h>
#include <pthread.h>
#include <sys/resource.h>

#include "hal/libav/entry_points.h"
#include "hal/program_part.h"

// The functions of the HAL that need libav, for the program: the first call of one of them loads
// libav and the libraries that come with it. A live painting of a camera that gives raw images
// never does.

namespace pleinair::hal {
namespace {

using libav::EntryPoints;

Error unusable(const std::string& problem) {
  return Error{.kind = ErrorKind::kNotFound,
               .subject = libav::kModuleFile,
               .problem = problem,
               .remedy = "start pleinair anew; if that does not help, install it again"};
}

/// dlopen() does not tell whether it is memory that it lacks.
bool isMemoryLimited() {
  rlimit memory{};
  return ::getrlimit(RLIMIT_AS, &memory) == 0 && memory.rlim_cur != RLIM_INFINITY;
}

Result<const EntryPoints*> loadModule() {
  const std::filesystem::path path = programPart(libav::kModuleFile);
  if (path.empty()) return tl::unexpected(unusable("is not there"));
  void* const module = ::dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
  if (module == nullptr && isMemoryLimited()) throw std::bad_alloc();
  if (module == nullptr) {
    const char* const problem = ::dlerror();  // NOLINT(concurrency-mt-unsafe): of this thread
    return tl::unexpected(
        unusable(std::string("cannot be loaded: ") + (problem == nullptr ? "" : problem)));
  }
  using Entry = const EntryPoints*();
  auto* const entry = reinterpret_cast<Entry*>(::dlsym(module, libav::kModuleSymbol));
  const EntryPoints* const points = entry == nullptr ? nullptr : entry();
  if (points == nullptr || points->build != libav::kBuild) {
    return tl::unexpected(unusable("is of another version: it was replaced in the meantime"));
  }
  return points;
}

/// By a thread of ordinary priority: it takes longer than a real-time thread may compute.
Result<const EntryPoints*> loadAside() {
  std::packaged_task<Result<const EntryPoints*>()> task(loadModule);
  std::thread([&task] {
    const sched_param ordinary{};
    pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);
    task();
  }).join();
  return task.get_future().get();
}

const Result<const EntryPoints*>& entryPoints() {
  static const Result<const EntryPoints*> kLoaded = loadAside();
  return kLoaded;
}

template <class T, class... Formal, class... Actual>
Result<T> call(Result<T> (*EntryPoints::*function)(Formal...), Actual&&... arguments) {
  const Result<const EntryPoints*>& loaded = entryPoints();
  if (!loaded) return tl::unexpected(loaded.error());
  return ((*loaded)->*function)(std::forward<Actual>(arguments)...);
}

}  // namespace

Result<Image> readPicture(const std::filesystem::path& path) {
  return call(&EntryPoints::readPicture, path);
}
Result<Image> readPictureRgb(const std::filesystem::path& path) {
  return call(&EntryPoints::readPictureRgb, path);
}
Result<Image> readPictureRgba(const std::filesystem::path& path) {
  return call(&EntryPoints::readPictureRgba, path);
}
Result<Image> decodeRgba(std::span<const std::uint8_t> bytes, const std::string& subject) {
  return call(&EntryPoints::decodeRgba, bytes, subject);
}
Result<Rgb16Image> readRgb16(const std::filesystem::path& path) {
  return call(&EntryPoints::readRgb16, path);
}

Result<libav::LentPicture> libav::decodeMotionJpeg(std::span<const std::uint8_t> bytes,
                                                   const std::string& subject) {
  return call(&EntryPoints::decodeMotionJpeg, bytes, subject);
}

std::unique_ptr<Camera> openRecording(std::filesystem::path path, Clock& clock,
                                      RecordingOptions options) {
  return orThrow(entryPoints())->openRecording(std::move(path), clock, std::move(options));
}
Result<void> forMovieFrames(const std::filesystem::path& movie, Duration from,
                            const TakeMovieFrame& take, const std::function<bool()>& isUnwanted) {
  return call(&EntryPoints::forMovieFrames, movie, from, take, isUnwanted);
}

std::unique_ptr<MemoryOutput> openMovieOutput(std::filesystem::path path, MovieOptions options,
                                              FileSystem& files) {
  return orThrow(entryPoints())->openMovieOutput(std::move(path), std::move(options), files);
}
std::unique_ptr<MemoryOutput> openMovieStream() {
  return orThrow(entryPoints())->openMovieStream();
}

Result<std::unique_ptr<captures::CaptureWriter>> captures::CaptureWriter::open(
    const std::filesystem::path& path, const CaptureHeader& header, TimePoint start) {
  return call(&EntryPoints::openCapture, path, header, start);
}

}  // namespace pleinair::hal
