#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace pleinair::support {

/// A PNG of 16-bit RGB, uncompressed. The product only reads such files.
class Rgb16Png {
 public:
  Rgb16Png(int width, int height)
      : width_(width), height_(height), samples_(3U * static_cast<std::size_t>(width * height)) {}

  void set(int x, int y, std::array<std::uint16_t, 3> rgb) {
    const std::size_t at = 3U * static_cast<std::size_t>(y * width_ + x);
    for (std::size_t c = 0; c < 3; ++c) samples_[at + c] = rgb.at(c);
  }

  void write(const std::filesystem::path& path) const {
    std::string bytes = "\x89PNG\r\n\x1a\n";
    std::string header =
        word(static_cast<std::uint32_t>(width_)) + word(static_cast<std::uint32_t>(height_));
    header += std::string("\x10\x02\0\0\0", 5);
    bytes += chunk("IHDR", header) + chunk("IDAT", zlib(rows())) + chunk("IEND", "");
    std::ofstream(path, std::ios::binary) << bytes;
  }

 private:
  static std::string word(std::uint32_t value) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 0xFFU);
    return text;
  }
  static std::uint32_t crc(const std::string& bytes) {
    std::uint32_t value = 0xFFFFFFFFU;
    for (const char c : bytes) {
      value ^= static_cast<unsigned char>(c);
      for (int bit = 0; bit < 8; ++bit) {
        value = (value >> 1U) ^ ((value & 1U) != 0 ? 0xEDB88320U : 0U);
      }
    }
    return ~value;
  }
  static std::string chunk(const std::string& name, const std::string& data) {
    return word(static_cast<std::uint32_t>(data.size())) + name + data + word(crc(name + data));
  }
  static std::string zlib(const std::string& data) {
    std::string bytes = "\x78\x01";
    constexpr std::size_t kMost = 65535;
    for (std::size_t at = 0; at < data.size(); at += kMost) {
      const std::string block = data.substr(at, kMost);
      const auto size = static_cast<unsigned>(block.size());
      bytes += at + kMost >= data.size() ? '\x01' : '\0';
      for (const unsigned value : {size, ~size}) {
        bytes += static_cast<char>(value & 0xFFU);
        bytes += static_cast<char>(value >> 8U & 0xFFU);
      }
      bytes += block;
    }
    std::uint32_t a = 1;
    std::uint32_t b = 0;
    for (const char c : data) {
      a = (a + static_cast<unsigned char>(c)) % 65521;
      b = (b + a) % 65521;
    }
    return bytes + word(b << 16U | a);
  }
  std::string rows() const {
    std::string bytes;
    const std::size_t row = 3U * static_cast<std::size_t>(width_);
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (i % row == 0) bytes += '\0';  // no filter
      bytes += static_cast<char>(samples_[i] >> 8U);
      bytes += static_cast<char>(samples_[i] & 0xFFU);
    }
    return bytes;
  }

  int width_, height_;
  std::vector<std::uint16_t> samples_;
};

/// A KITTI file with one flow vector everywhere.
inline Rgb16Png constantFlow(int width, int height, double u, double v) {
  Rgb16Png png(width, height);
  const auto coded = [](double px) { return static_cast<std::uint16_t>(32768 + 64 * px); };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) png.set(x, y, {coded(u), coded(v), 1});
  }
  return png;
}

}  // namespace pleinair::support
