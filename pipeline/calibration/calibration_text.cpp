#include "pipeline/calibration/calibration_text.h"

#include <array>
#include <cassert>
#include <string_view>

#include <fmt/format.h>

namespace pleinair::calibration {

std::string calibrationText(const Board& board, const CalibrationReport& report) {
  assert(report.choice);
  const LensChoice& choice = *report.choice;
  const LensFit& fit = choice.fit;
  const hal::FrameSize size = fit.camera.imageSize();
  const LensVector lens = parametersOf(fit.camera);
  std::size_t corners = 0;
  for (const FitView& view : choice.used) corners += view.size();

  std::string text = "# A camera's lens, found by pleinair calibrate.\n";
  text += fmt::format("# Board: {}.\n", board.text());
  text += fmt::format("# {} views, {} corners.\n", choice.used.size(), corners);
  text += fmt::format("# Error: {:.3f} px RMS; {:.3f} px in views left out of the fit.\n",
                      fit.rmsPx, choice.heldOutRmsPx);
  text += fmt::format("# Known to {:.2f} px in most of the picture, to {:.2f} px in {}.\n",
                      report.typicalSigmaPx, report.worstSigmaPx, report.worstPlace);
  text += fmt::format("# Lens: {}. Standard deviations:\n", toString(fit.model));
  constexpr std::array<std::string_view, kLensParameters> kNames{"fx", "fy", "cx", "cy", "k1",
                                                                 "k2", "p1", "p2", "k3"};
  text += "#";
  for (std::size_t i = 0; i < kLensParameters; ++i) {
    if (fit.sigma(i) > 0.0) text += fmt::format(" {} {:.2g}", kNames.at(i), fit.sigma(i));
  }
  text += fmt::format("\nimage_size = [{}, {}]\n", size.width, size.height);
  for (std::size_t i = 0; i < 4; ++i) text += fmt::format("{} = {:.4f}\n", kNames.at(i), lens[i]);
  text += "pixel_centres = \"half\"\n";
  text += fmt::format("distortion = [{:.8g}, {:.8g}, {:.8g}, {:.8g}, {:.8g}]\n", lens[4], lens[5],
                      lens[6], lens[7], lens[8]);
  return text;
}

}  // namespace pleinair::calibration
