#include "firmware_app/sheets/printed_page.h"

#include <new>
#include <utility>

#include <cairo-pdf.h>
#include <cairo.h>

namespace pleinair::app {
namespace {

constexpr double kPointsPerMm = 72.0 / 25.4;

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  auto& all = *static_cast<std::vector<std::uint8_t>*>(bytes);
  all.insert(all.end(), data, data + length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

void PrintedPages::Deleter::operator()(_cairo* context) const {
  cairo_destroy(context);
}
void PrintedPages::Deleter::operator()(_cairo_surface* surface) const {
  cairo_surface_destroy(surface);
}

PrintedPages::PrintedPages(PaperSize paper)
    : paper_(paper),
      surface_(cairo_pdf_surface_create_for_stream(append, &bytes_, paper.widthMm * kPointsPerMm,
                                                   paper.heightMm * kPointsPerMm)),
      context_(cairo_create(surface_.get())) {
  if (cairo_status(context_.get()) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
  cairo_pdf_surface_set_metadata(surface_.get(), CAIRO_PDF_METADATA_CREATE_DATE,
                                 "2000-01-01T00:00:00Z");  // the same bytes each time
  cairo_pdf_surface_set_metadata(surface_.get(), CAIRO_PDF_METADATA_TITLE, "pleinair tags");
  cairo_scale(context_.get(), kPointsPerMm, kPointsPerMm);
  cairo_select_font_face(context_.get(), "Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
}

PrintedPages::~PrintedPages() {
  context_.reset();
  surface_.reset();  // it writes to bytes_
}

void PrintedPages::fill(const std::vector<PaperRect>& rects) {
  cairo_t* const context = context_.get();
  cairo_set_source_rgb(context, 0, 0, 0);
  for (const PaperRect& each : rects) {
    cairo_rectangle(context, each.x, each.y, each.width, each.height);
  }
  cairo_fill(context);
}

void PrintedPages::line(double fromX, double fromY, double toX, double toY) {
  cairo_t* const context = context_.get();
  cairo_set_source_rgb(context, 0.6, 0.6, 0.6);
  cairo_set_line_width(context, 0.2);
  cairo_move_to(context, fromX, fromY);
  cairo_line_to(context, toX, toY);
  cairo_stroke(context);
}

void PrintedPages::text(double x, double y, double heightMm, const std::string& text) {
  cairo_t* const context = context_.get();
  cairo_set_source_rgb(context, 0, 0, 0);
  cairo_set_font_size(context, heightMm);
  cairo_move_to(context, x, y);
  cairo_show_text(context, text.c_str());
}

void PrintedPages::rulers() {
  constexpr double kLineMm = 0.3;
  const double left = kRulerInsetMm;
  const double base = paper_.heightMm - kRulerInsetMm;
  std::vector<PaperRect> marks{{left, base, kRulerMm, kLineMm},
                               {left - kLineMm, base - kRulerMm, kLineMm, kRulerMm}};
  for (int mm = 1; mm <= static_cast<int>(kRulerMm); ++mm) {
    const double length = mm % 10 == 0 ? 4.0 : mm % 5 == 0 ? 3.0 : 1.8;
    const double width = mm % 10 == 0 ? 0.2 : 0.1;
    // The last one lies within, so that the ruler is as long as it says; the other ruler is at 0.
    const double at = mm == static_cast<int>(kRulerMm) ? mm - width : mm - width / 2;
    marks.push_back({left + at, base, width, length});
    marks.push_back({left - length, base - at - width, length, width});
  }
  fill(marks);
  for (int mm = 20; mm <= static_cast<int>(kRulerMm); mm += 20) {
    text(left + mm - 2.0, base + 7.0, 2.8, std::to_string(mm));
    text(left - 10.0, base - mm + 1.0, 2.8, std::to_string(mm));
  }
  text(left + kRulerMm + 4.0, base + 3.5, 3.0, "mm. Print at 100 %, not fitted to the page,");
  text(left + kRulerMm + 4.0, base + 7.5, 3.0, "and measure both rulers: 100 mm each.");
}

void PrintedPages::endPage() {
  cairo_show_page(context_.get());
}

std::vector<std::uint8_t> PrintedPages::finish() {
  context_.reset();
  cairo_surface_finish(surface_.get());
  if (cairo_surface_status(surface_.get()) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
  return std::move(bytes_);
}

}  // namespace pleinair::app
