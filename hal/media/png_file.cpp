#include "hal/media/png_file.h"

#include <array>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include <png.h>

#include "hal/pending_file.h"

namespace pleinair::hal {
namespace {

std::optional<int> colourTypeOf(PixelFormat format) {
  switch (format) {
    case PixelFormat::kRgb8:
      return PNG_COLOR_TYPE_RGB;
    case PixelFormat::kRgba8:
      return PNG_COLOR_TYPE_RGBA;
    case PixelFormat::kGrey8:
      return PNG_COLOR_TYPE_GRAY;
    default:
      return std::nullopt;
  }
}

/// libpng's callbacks. Its errors come back by longjmp, past frames without destructors only.
struct PngWriting {
  std::vector<std::uint8_t> bytes;
  std::array<char, 128> message{};
  bool isOutOfMemory = false;

  static void write(png_structp png, png_bytep data, std::size_t size) {
    auto* const writing = static_cast<PngWriting*>(png_get_io_ptr(png));
    try {
      writing->bytes.insert(writing->bytes.end(), data, data + size);
    } catch (const std::bad_alloc&) {
      writing->isOutOfMemory = true;
    }
  }
  static void flush(png_structp) {}
  static void ignoreWarning(png_structp, png_const_charp) {}
  [[noreturn]] static void fail(png_structp png, png_const_charp message) {
    auto* const writing = static_cast<PngWriting*>(png_get_error_ptr(png));
    std::snprintf(writing->message.data(), writing->message.size(), "%s", message);
    png_longjmp(png, 1);
  }
};

/// The part of encodePng() between setjmp() and longjmp(): no object in it has a destructor.
bool runPngJob(png_structp png, png_infop info, const ImageView& picture, int colourType,
               const PngTags& tags) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  const FrameSize size = picture.format.size;
  png_set_IHDR(png, info, static_cast<png_uint_32>(size.width),
               static_cast<png_uint_32>(size.height), 8, colourType, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 1);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  if (tags.isSrgb) png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (tags.dotsPerInch) {
    constexpr double kInchesPerMetre = 1.0 / 0.0254;
    const auto dots = static_cast<png_uint_32>(std::lround(*tags.dotsPerInch * kInchesPerMetre));
    png_set_pHYs(png, info, dots, dots, PNG_RESOLUTION_METER);
  }
  png_write_info(png, info);
  for (int y = 0; y < size.height; ++y) png_write_row(png, picture.row(0, y).data());
  png_write_end(png, info);
  return true;
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct FreePng {
  void operator()(png_image* image) const { png_image_free(image); }
};

Error brokenPng(const std::string& subject, const png_image& image) {
  return Error{.kind = ErrorKind::kInvalidInput,
               .subject = subject,
               .problem = std::string("is a broken picture: ") + image.message,
               .remedy = "give a complete PNG picture"};
}

}  // namespace

Result<std::vector<std::uint8_t>> encodePng(const ImageView& picture, const PngTags& tags) {
  assert(picture.isComplete());
  const std::optional<int> colourType = colourTypeOf(picture.format.pixelFormat);
  if (!colourType) {
    const std::string format(toString(picture.format.pixelFormat));
    return tl::unexpected(Error{
        .kind = ErrorKind::kUnsupported, .subject = "PNG", .problem = "cannot hold " + format});
  }
  PngWriting writing;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writing, PngWriting::fail,
                                            PngWriting::ignoreWarning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  const bool hasMemory = info != nullptr;
  bool isDone = false;
  if (hasMemory) {
    png_set_write_fn(png, &writing, PngWriting::write, PngWriting::flush);
    isDone = runPngJob(png, info, picture, *colourType, tags);
  }
  png_destroy_write_struct(&png, &info);
  if (!hasMemory || writing.isOutOfMemory) throw std::bad_alloc();
  if (isDone) return std::move(writing.bytes);
  return tl::unexpected(Error{.kind = ErrorKind::kInternal,
                              .subject = "PNG",
                              .problem = std::string("cannot encode: ") + writing.message.data()});
}

Result<void> writePng(const std::filesystem::path& path, const ImageView& picture) {
  const Result<std::vector<std::uint8_t>> bytes = encodePng(picture);
  if (!bytes) return tl::unexpected(bytes.error());
  Result<PendingFile> file = PendingFile::create(path);
  if (!file) return tl::unexpected(file.error());
  if (Result<void> written = file->write(*bytes); !written) return written;
  return file->publish();
}

Result<Image> readOwnPng(const std::filesystem::path& path) {
  const std::string subject = path.string();
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rbe"));
  if (file == nullptr) return tl::unexpected(errnoError(subject, "cannot open", errno));
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, FreePng> image(&header);
  if (png_image_begin_read_from_stdio(image.get(), file.get()) == 0) {
    return tl::unexpected(brokenPng(subject, header));
  }
  image->format = PNG_FORMAT_RGB;
  constexpr auto kMostPixels = static_cast<png_uint_32>(kMaxSidePixels);
  if (image->width > kMostPixels || image->height > kMostPixels ||
      !isAcceptedSize({static_cast<int>(image->width), static_cast<int>(image->height)})) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = subject,
                                .problem = "is larger than pictures may be"});
  }
  Image picture({.pixelFormat = PixelFormat::kRgb8,
                 .size = {static_cast<int>(image->width), static_cast<int>(image->height)},
                 .encoding = {}});
  const auto stride = static_cast<png_int_32>(picture.view().planes[0].strideBytes);
  if (png_image_finish_read(image.get(), nullptr, picture.plane(0).data(), stride, nullptr) == 0 ||
      PNG_IMAGE_FAILED(header)) {
    return tl::unexpected(brokenPng(subject, header));
  }
  return picture;
}

}  // namespace pleinair::hal
