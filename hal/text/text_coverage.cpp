#include "hal/text/text_coverage.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <memory>

#include <pango/pangocairo.h>

namespace pleinair::hal {
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

Layout layoutOf(PangoContext* context, const std::string& text, const TextLayout& how) {
  Layout layout(pango_layout_new(context));
  const Font font(pango_font_description_from_string(how.font.c_str()));
  pango_font_description_set_absolute_size(font.get(), double{PANGO_SCALE} * how.fontPixels);
  pango_layout_set_font_description(layout.get(), font.get());
  const Tabs tabs(pango_tab_array_new_with_positions(1, TRUE, PANGO_TAB_LEFT,
                                                     kSecondColumnEms * how.fontPixels));
  pango_layout_set_tabs(layout.get(), tabs.get());
  const Text sound(g_utf8_make_valid(text.data(), static_cast<gssize>(text.size())));
  pango_layout_set_text(layout.get(), sound.get(), -1);
  int width = 0;
  pango_layout_get_pixel_size(layout.get(), &width, nullptr);
  if (how.isCentred) pango_layout_set_alignment(layout.get(), PANGO_ALIGN_CENTER);
  if (width > how.maxWidth) {
    pango_layout_set_width(layout.get(), how.maxWidth * PANGO_SCALE);
    if (how.tooWide == TextLayout::TooWide::kWrap) {
      pango_layout_set_wrap(layout.get(), PANGO_WRAP_WORD_CHAR);
    } else {
      pango_layout_set_ellipsize(layout.get(), PANGO_ELLIPSIZE_END);
    }
  }
  return layout;
}

/// Whether the layout has a font: without any, some of Pango's lines are of any height.
bool hasFont(PangoLayout* layout, int heightPixels, int fontPixels) {
  constexpr int kMostEms = 16;  // of a line, in any script
  return heightPixels > 0 &&
         heightPixels <= kMostEms * fontPixels * pango_layout_get_line_count(layout);
}

}  // namespace

Image textCoverage(const std::string& text, const TextLayout& how) {
  assert(how.fontPixels > 0 && how.maxWidth > 0);
  // The thread's own, which keeps the font that it has loaded.
  const Context context(pango_font_map_create_context(pango_cairo_font_map_get_default()));
  const Layout layout = layoutOf(context.get(), text, how);
  PangoRectangle extents;
  pango_layout_get_pixel_extents(layout.get(), nullptr, &extents);
  if (!hasFont(layout.get(), extents.height, how.fontPixels)) {
    return Image({.pixelFormat = PixelFormat::kGrey8, .size = {how.fontPixels, how.fontPixels}});
  }
  const FrameSize size{std::clamp(extents.width, 1, kMaxSidePixels),
                       std::clamp(extents.height, 1, kMaxSidePixels)};
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, size.width, size.height));
  const Canvas canvas(cairo_create(surface.get()));
  cairo_move_to(canvas.get(), -extents.x, -extents.y);  // wrapped, centred lines begin within
  pango_cairo_show_layout(canvas.get(), layout.get());
  cairo_surface_flush(surface.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
  const std::size_t bytes = stride * static_cast<std::size_t>(size.height);
  return Image(
      ImageView{.format = {.pixelFormat = PixelFormat::kGrey8, .size = size},
                .planes = {PlaneView{.bytes = {cairo_image_surface_get_data(surface.get()), bytes},
                                     .strideBytes = stride}}});
}

}  // namespace pleinair::hal
