#include "hal/outputs/window/caption.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

#include <pango/pangocairo.h>

namespace pleinair::hal::window {
namespace {

template <auto kRelease>
struct Release {
  template <class T>
  void operator()(T* object) const {
    kRelease(object);
  }
};
using Context = std::unique_ptr<PangoContext, Release<g_object_unref>>;
using Layout = std::unique_ptr<PangoLayout, Release<g_object_unref>>;
using Font = std::unique_ptr<PangoFontDescription, Release<pango_font_description_free>>;
using Text = std::unique_ptr<char, Release<g_free>>;
using Tabs = std::unique_ptr<PangoTabArray, Release<pango_tab_array_free>>;
using Surface = std::unique_ptr<cairo_surface_t, Release<cairo_surface_destroy>>;
using Canvas = std::unique_ptr<cairo_t, Release<cairo_destroy>>;

constexpr int kSecondColumnEms = 10;

Layout layoutOf(PangoContext* context, const std::string& text, int fontPixels, int mostWidth) {
  Layout layout(pango_layout_new(context));
  const Font font(pango_font_description_from_string("Sans"));
  pango_font_description_set_absolute_size(font.get(), double{PANGO_SCALE} * fontPixels);
  pango_layout_set_font_description(layout.get(), font.get());
  const Tabs tabs(
      pango_tab_array_new_with_positions(1, TRUE, PANGO_TAB_LEFT, kSecondColumnEms * fontPixels));
  pango_layout_set_tabs(layout.get(), tabs.get());
  const Text sound(g_utf8_make_valid(text.data(), static_cast<gssize>(text.size())));
  pango_layout_set_text(layout.get(), sound.get(), -1);
  int width = 0;
  pango_layout_get_pixel_size(layout.get(), &width, nullptr);
  if (width > mostWidth) {
    pango_layout_set_width(layout.get(), mostWidth * PANGO_SCALE);
    pango_layout_set_ellipsize(layout.get(), PANGO_ELLIPSIZE_END);
  }
  return layout;
}

}  // namespace

Image captionPicture(const std::string& text, int fontPixels, int mostWidth) {
  assert(fontPixels > 0 && mostWidth > 0);
  // The thread's own, which keeps the font that it has loaded.
  const Context context(pango_font_map_create_context(pango_cairo_font_map_get_default()));
  const Layout layout = layoutOf(context.get(), text, fontPixels, mostWidth);
  FrameSize size;
  pango_layout_get_pixel_size(layout.get(), &size.width, &size.height);
  size = {std::clamp(size.width, 1, kMaxSidePixels), std::clamp(size.height, 1, kMaxSidePixels)};
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, size.width, size.height));
  const Canvas canvas(cairo_create(surface.get()));
  pango_cairo_show_layout(canvas.get(), layout.get());
  cairo_surface_flush(surface.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
  const std::size_t bytes = stride * static_cast<std::size_t>(size.height);
  return Image(
      ImageView{.format = {.pixelFormat = PixelFormat::kGrey8, .size = size},
                .planes = {PlaneView{.bytes = {cairo_image_surface_get_data(surface.get()), bytes},
                                     .strideBytes = stride}}});
}

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
  texture_ = textureOf(renderer, captionPicture(text_, fontPixels, mostWidth));
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
