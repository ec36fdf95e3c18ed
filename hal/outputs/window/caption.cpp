#include "hal/outputs/window/caption.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "hal/text/text_coverage.h"

namespace pleinair::hal::window {
namespace {

constexpr double kFontUnits = 15.0;  // of the desktop
constexpr double kMarginUnits = 12.0;
constexpr double kPaddingUnits = 7.0;
constexpr double kBandOpacity = 0.6;

int inPixels(double units, double pixelScale) {
  return std::max(1, static_cast<int>(std::lround(units * pixelScale)));
}

std::uint8_t levelOf(double part) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(part, 0.0, 1.0)));
}

TextureHandle textureOf(SDL_Renderer* renderer, const Image& coverage) {
  const FrameSize size = coverage.size();
  Image white({.pixelFormat = PixelFormat::kRgba8, .size = size});
  const ImageView view = coverage.view();
  for (int y = 0; y < size.height; ++y) {
    const auto from = view.row(0, y);
    const auto to = white.row(0, y);
    std::ranges::fill(to, std::uint8_t{255});
    for (std::size_t x = 0; x < from.size(); ++x) to[4 * x + 3] = from[x];
  }
  TextureHandle texture(SDL_CreateTexture(renderer, SDL_PIXELFORMAT_RGBA32,
                                          SDL_TEXTUREACCESS_STATIC, size.width, size.height));
  if (texture == nullptr) return texture;
  const auto pixels = white.plane(0);
  SDL_UpdateTexture(texture.get(), nullptr, pixels.data(), 4 * size.width);
  SDL_SetTextureBlendMode(texture.get(), SDL_BLENDMODE_BLEND);
  return texture;
}

}  // namespace

void Caption::set(const std::string& text, double opacity) {
  opacity_ = opacity;
  if (text_ == text) return;
  text_ = text;
  texture_.reset();
}

void Caption::prepare(SDL_Renderer* renderer, int fontPixels, int mostWidth) {
  if (texture_ != nullptr && fontPixels == fontPixels_ && mostWidth == mostWidth_) return;
  texture_ =
      textureOf(renderer, textCoverage(text_, {.fontPixels = fontPixels, .maxWidth = mostWidth}));
  fontPixels_ = fontPixels;
  mostWidth_ = mostWidth;
}

void Caption::draw(SDL_Renderer* renderer, double pixelScale) {
  if (text_.empty() || opacity_ <= 0.0) return;
  const int margin = inPixels(kMarginUnits, pixelScale);
  const int padding = inPixels(kPaddingUnits, pixelScale);
  int width = 0;
  int height = 0;
  SDL_GetRendererOutputSize(renderer, &width, &height);
  const int mostWidth = width - 2 * (margin + padding);
  if (mostWidth <= 0) return;  // nobody could read it
  prepare(renderer, inPixels(kFontUnits, pixelScale), mostWidth);
  // A caption that cannot be had is not worth the picture.
  if (texture_ == nullptr) return;
  SDL_Rect text{.x = margin + padding, .y = 0, .w = 0, .h = 0};
  SDL_QueryTexture(texture_.get(), nullptr, nullptr, &text.w, &text.h);
  text.y = height - margin - padding - text.h;
  const SDL_Rect band{.x = text.x - padding,
                      .y = text.y - padding,
                      .w = text.w + 2 * padding,
                      .h = text.h + 2 * padding};
  SDL_SetRenderDrawBlendMode(renderer, SDL_BLENDMODE_BLEND);
  SDL_SetRenderDrawColor(renderer, 0, 0, 0, levelOf(kBandOpacity * opacity_));
  SDL_RenderFillRect(renderer, &band);
  SDL_SetTextureAlphaMod(texture_.get(), levelOf(opacity_));
  SDL_RenderCopy(renderer, texture_.get(), nullptr, &text);
}

}  // namespace pleinair::hal::window
