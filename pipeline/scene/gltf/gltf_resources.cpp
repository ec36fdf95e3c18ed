#include "pipeline/scene/gltf/gltf_resources.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "config/config_error.h"
#include "hal/media/file_input.h"
#include "hal/media/picture_file.h"
#include "hal/media/picture_header.h"
#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"

namespace pleinair::scene::gltf {
namespace {

constexpr const char* kInside = "a file in the model's folder, or a data: URI";

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Decodes percent escapes: "%20" becomes a space.
std::string percentDecoded(std::string_view text, const std::string& where) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    const int high = i + 1 < text.size() ? hexDigit(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? hexDigit(text[i + 2]) : -1;
    if (high < 0 || low < 0) refuse(where, "has a % without two hexadecimal digits");
    decoded += static_cast<char>(16 * high + low);
    i += 2;
  }
  return decoded;
}

int base64Digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : -1;
}

std::vector<std::uint8_t> base64Decoded(std::string_view text, const std::string& where) {
  const std::size_t end = text.find_last_not_of('=');
  const std::size_t digits = end == std::string_view::npos ? 0 : end + 1;
  if (digits % 4 == 1 || text.size() - digits > 2) refuse(where, "is broken base64");
  std::vector<std::uint8_t> bytes;
  bytes.reserve(digits * 3 / 4);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < digits; ++i) {
    const int digit = base64Digit(text[i]);
    if (digit < 0) refuse(where, "is broken base64");
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if (i % 4 != 0) bytes.push_back(static_cast<std::uint8_t>(bits >> (6 - 2 * (i % 4))));
  }
  return bytes;
}

bool isData(std::string_view uri) {
  return uri.starts_with("data:");
}

bool hasScheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos && uri.find('/') > colon;
}

}  // namespace

std::vector<std::uint8_t> readWholeFile(const std::filesystem::path& path, std::int64_t maxBytes,
                                        const std::string& where) {
  const hal::Result<hal::FileInput> file = hal::FileInput::open(path);
  if (!file) {
    const hal::Error& error = file.error();
    // FileInput's remedy for an empty or missing file is about movies; replace it.
    const bool isNone = error.kind == hal::ErrorKind::kInvalidInput;
    throw Fault(error.kind, where, error.problem,
                isNone ? "export or copy it again" : error.remedy);
  }
  if (file->sizeBytes() > maxBytes) {
    refuse(where, fmt::format("takes {} MiB", file->sizeBytes() >> 20),
           fmt::format("at most {} MiB for a model and all its files", kMaxResourceBytes >> 20));
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(file->sizeBytes()));
  if (file->readAt(0, bytes.data(), bytes.size()) != file->sizeBytes()) {
    throw Fault(hal::ErrorKind::kIo, where, "cannot be read");
  }
  return bytes;
}

std::filesystem::path fileOf(std::string_view uri, const std::filesystem::path& folder,
                             const std::string& where) {
  const std::string shown = "found " + config::quoted(std::string(uri));
  if (uri.empty() || hasScheme(uri)) refuse(where, shown, kInside);
  const std::string name = percentDecoded(uri, where);
  const std::filesystem::path relative(name);
  const bool leads = relative.is_absolute() || name.find('\0') != std::string::npos ||
                     name.find('\\') != std::string::npos ||
                     std::ranges::find(relative, "..") != relative.end();
  if (leads) refuse(where, shown, kInside);

  std::error_code code;
  const std::filesystem::path root =
      std::filesystem::canonical(folder.empty() ? std::filesystem::path(".") : folder, code);
  if (code) refuse(where, "the model's folder cannot be opened: " + code.message());
  std::filesystem::path file = std::filesystem::canonical(root / relative, code);
  if (code) {
    const bool isMissing = code == std::errc::no_such_file_or_directory;
    throw Fault(isMissing ? hal::ErrorKind::kNotFound : hal::ErrorKind::kIo, where,
                shown + ", which cannot be opened: " + code.message());
  }
  const auto [inRoot, inFile] = std::ranges::mismatch(root, file);
  if (inRoot != root.end()) refuse(where, shown + ", a link out of the model's folder", kInside);
  return file;
}

std::vector<std::uint8_t> bytesOfDataUri(std::string_view uri, const std::string& where) {
  const std::size_t comma = uri.find(',');
  if (!isData(uri) || comma == std::string_view::npos) refuse(where, "is a data: URI without data");
  const std::string_view data = uri.substr(comma + 1);
  if (uri.substr(0, comma).ends_with(";base64")) return base64Decoded(data, where);
  const std::string text = percentDecoded(data, where);
  return {text.begin(), text.end()};
}

Resources::Resources(const Structure& structure,
                     std::optional<std::span<const std::uint8_t>> binary,
                     std::optional<std::filesystem::path> folder)
    : structure_(structure),
      binary_(binary),
      folder_(std::move(folder)),
      bytesLeft_(kMaxResourceBytes),
      pixelsLeft_(kMaxTexturePixels) {}

std::vector<std::uint8_t> Resources::load(std::string_view uri, const std::string& where) {
  std::vector<std::uint8_t> bytes;
  if (isData(uri)) {
    bytes = bytesOfDataUri(uri, where);
  } else if (folder_) {
    bytes = readWholeFile(fileOf(uri, *folder_, where), bytesLeft_, where);
  } else {
    refuse(where, "found " + config::quoted(std::string(uri)), "a data: URI: there is no folder");
  }
  bytesLeft_ -= static_cast<std::int64_t>(bytes.size());
  if (bytesLeft_ < 0) {
    refuse(where, "exceeds the size limit",
           fmt::format("at most {} MiB for a model and all its files", kMaxResourceBytes >> 20));
  }
  return bytes;
}

std::span<const std::uint8_t> Resources::buffer(std::size_t index, const std::string& where) {
  if (index >= structure_.buffers.size()) {
    refuse(where, fmt::format("there is no buffers[{}]", index));
  }
  const BufferEntry& entry = structure_.buffers[index];
  const std::string name = fmt::format("buffers[{}]", index);
  std::span<const std::uint8_t> bytes;
  if (entry.uri) {
    auto known = buffers_.find(index);
    if (known == buffers_.end()) {
      known = buffers_.emplace(index, load(*entry.uri, name + ".uri")).first;
    }
    bytes = known->second;
  } else if (index == 0 && binary_) {
    bytes = *binary_;
  } else {
    refuse(name, "has no uri", "one, or a .glb with a BIN chunk for the first");
  }
  if (entry.byteLength > bytes.size()) {
    refuse(name + ".byteLength",
           fmt::format("found {}, but it has {} bytes", entry.byteLength, bytes.size()));
  }
  return bytes.first(static_cast<std::size_t>(entry.byteLength));
}

std::span<const std::uint8_t> Resources::bufferView(std::size_t index, const std::string& where) {
  const auto& views = structure_.gltf.bufferViews;
  if (index >= views.size()) refuse(where, fmt::format("there is no bufferViews[{}]", index));
  const tinygltf::BufferView& view = views[index];
  const std::string name = fmt::format("bufferViews[{}]", index);
  if (view.buffer < 0) refuse(name + ".buffer", "missing");
  const auto bytes = buffer(static_cast<std::size_t>(view.buffer), name + ".buffer");
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset) {
    refuse(name, fmt::format("reaches to byte {} + {} of buffers[{}], which has {}",
                             view.byteOffset, view.byteLength, view.buffer, bytes.size()));
  }
  return bytes.subspan(view.byteOffset, view.byteLength);
}

std::shared_ptr<const hal::Image> Resources::image(std::size_t index, const std::string& where) {
  if (index >= structure_.images.size()) {
    refuse(where, fmt::format("there is no images[{}]", index));
  }
  if (const auto known = images_.find(index); known != images_.end()) return known->second;
  const ImageEntry& entry = structure_.images[index];
  const std::string name = fmt::format("images[{}]", index);
  std::shared_ptr<const hal::Image> picture;
  if (entry.uri) {
    picture = decode(load(*entry.uri, name + ".uri"), name);
  } else if (entry.bufferView) {
    picture = decode(bufferView(*entry.bufferView, name + ".bufferView"), name);
  } else {
    refuse(name, "has neither uri nor bufferView");
  }
  return images_.emplace(index, std::move(picture)).first->second;
}

std::shared_ptr<const hal::Image> Resources::decode(std::span<const std::uint8_t> bytes,
                                                    const std::string& where) {
  using hal::PictureKind;
  const auto kind = hal::pictureKindOf(bytes);
  if (kind != PictureKind::kPng && kind != PictureKind::kJpeg && kind != PictureKind::kWebp) {
    refuseUnsupported(where, "is a picture of a kind that is not read", "a PNG or JPEG");
  }
  const auto size = hal::peekPictureSize(*kind, bytes);
  if (!size) refuse(where, "is a broken picture");
  if (std::max(size->width, size->height) > kMaxTextureSide || size->pixels() > pixelsLeft_) {
    refuse(where, fmt::format("has {}x{} px", size->width, size->height),
           fmt::format("at most {} px a side, and {} Mpx in all pictures together", kMaxTextureSide,
                       kMaxTexturePixels / 1'000'000));
  }
  hal::Result<hal::Image> picture = hal::decodeRgba(bytes, where);
  if (!picture) throw Fault(picture.error().kind, where, picture.error().problem);
  pixelsLeft_ -= picture->size().pixels();
  return std::make_shared<const hal::Image>(*std::move(picture));
}

}  // namespace pleinair::scene::gltf
