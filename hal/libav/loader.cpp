#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include <dlfcn.h>

#include "hal/libav/entry_points.h"
#include "hal/program_part.h"

// The functions of the HAL that need libav, for the program: the first call of one of them loads
// libav and the 130 libraries that come with it. A live painting of a camera that gives raw images
// never does.

namespace pleinair::hal {
namespace {

const libav::EntryPoints& loadModule() {
  const std::filesystem::path path = programPart(libav::kModuleFile);
  void* const module =
      path.empty() ? nullptr : ::dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
  if (module == nullptr) {
    const char* const problem = path.empty() ? "it is not there" : ::dlerror();
    throw std::runtime_error(std::string("cannot load ") + libav::kModuleFile + ": " +
                             (problem == nullptr ? "" : problem) + "; install pleinair again");
  }
  using Entry = const libav::EntryPoints*();
  return *reinterpret_cast<Entry*>(::dlsym(module, libav::kModuleSymbol))();
}

const libav::EntryPoints& entryPoints() {
  static const libav::EntryPoints& kLoaded = loadModule();
  return kLoaded;
}

}  // namespace

Result<Image> readPicture(const std::filesystem::path& path) {
  return entryPoints().readPicture(path);
}
Result<Image> readPictureRgb(const std::filesystem::path& path) {
  return entryPoints().readPictureRgb(path);
}
Result<Image> readPictureRgba(const std::filesystem::path& path) {
  return entryPoints().readPictureRgba(path);
}
Result<Image> decodeRgba(std::span<const std::uint8_t> bytes, const std::string& subject) {
  return entryPoints().decodeRgba(bytes, subject);
}
Result<Rgb16Image> readRgb16(const std::filesystem::path& path) {
  return entryPoints().readRgb16(path);
}

Result<libav::LentPicture> libav::decodeMotionJpeg(std::span<const std::uint8_t> bytes,
                                                   const std::string& subject) {
  return entryPoints().decodeMotionJpeg(bytes, subject);
}

std::unique_ptr<Camera> openRecording(std::filesystem::path path, Clock& clock,
                                      RecordingOptions options) {
  return entryPoints().openRecording(std::move(path), clock, std::move(options));
}
Result<void> forMovieFrames(const std::filesystem::path& movie, Duration from,
                            const TakeMovieFrame& take, const std::function<bool()>& isUnwanted) {
  return entryPoints().forMovieFrames(movie, from, take, isUnwanted);
}

std::unique_ptr<MemoryOutput> openMovieOutput(std::filesystem::path path, MovieOptions options,
                                              FileSystem& files) {
  return entryPoints().openMovieOutput(std::move(path), std::move(options), files);
}
std::unique_ptr<MemoryOutput> openMovieStream() {
  return entryPoints().openMovieStream();
}

Result<std::unique_ptr<captures::CaptureWriter>> captures::CaptureWriter::open(
    const std::filesystem::path& path, const CaptureHeader& header, TimePoint start) {
  return entryPoints().openCapture(path, header, start);
}

}  // namespace pleinair::hal
