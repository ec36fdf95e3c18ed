#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

struct _cairo;
struct _cairo_surface;

namespace pleinair::app {

/// Millimetres on paper, from its upper left corner.
struct PaperSize {
  double widthMm = 210;
  double heightMm = 297;
  friend bool operator==(const PaperSize&, const PaperSize&) = default;
};
struct PaperRect {
  double x = 0;
  double y = 0;
  double width = 0;
  double height = 0;
};

/// A PDF of pages in millimetres, by cairo; the same calls give the same bytes with the same cairo
/// and fonts. One thread.
class PrintedPages {
 public:
  explicit PrintedPages(PaperSize paper);
  ~PrintedPages();
  PrintedPages(const PrintedPages&) = delete;
  PrintedPages& operator=(const PrintedPages&) = delete;

  /// Fills all of them with black at once, so that no seam shows where they touch.
  void fill(const std::vector<PaperRect>& rects);
  /// A grey line of 0.2 mm.
  void line(double fromX, double fromY, double toX, double toY);
  /// Text whose capitals are about 0.7 `heightMm` high; (x, y) is the left end of its base line.
  void text(double x, double y, double heightMm, const std::string& text);
  /// Rulers of 100 mm along the left and lower edges of the page, with what to do with them.
  void rulers();
  void endPage();

  /// The whole PDF. No call may follow.
  std::vector<std::uint8_t> finish();

  const PaperSize& paper() const { return paper_; }

 private:
  struct Deleter {
    void operator()(_cairo* context) const;
    void operator()(_cairo_surface* surface) const;
  };

  PaperSize paper_;
  std::vector<std::uint8_t> bytes_;
  std::unique_ptr<_cairo_surface, Deleter> surface_;
  std::unique_ptr<_cairo, Deleter> context_;
};

/// Where the corner of both rulers is, and how long they are.
inline constexpr double kRulerInsetMm = 12;
inline constexpr double kRulerMm = 100;

}  // namespace pleinair::app
