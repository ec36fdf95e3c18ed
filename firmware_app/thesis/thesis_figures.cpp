#include "firmware_app/thesis/thesis_figures.h"

#include <array>

namespace pleinair::app {

std::span<const ThesisFigureKind> thesisFigures() {
  static constexpr std::array kFigures{
      ThesisFigureKind{"15_16_21", fieldFigure},
      ThesisFigureKind{"17_18", featureFigure},
      ThesisFigureKind{"19_20", strokeFigure},
      ThesisFigureKind{"22_24_25", photographFigure},
      ThesisFigureKind{"23_31", blendingFigure},
      ThesisFigureKind{"26", livesFigure},
      ThesisFigureKind{"27_table_1", stagesFigure},
      ThesisFigureKind{"28", densityFigure},
      ThesisFigureKind{"29_32_34_35", staticModelFigure},
      ThesisFigureKind{"30_33", skinnedModelFigure},
      ThesisFigureKind{"morphing", morphingModelFigure},
      ThesisFigureKind{"36_37", staticSpacesFigure},
      ThesisFigureKind{"38_39", animatedSpacesFigure},
      ThesisFigureKind{"40", memoryFigure},
      ThesisFigureKind{"41", clipFigure},
      ThesisFigureKind{"42", bumpFigure},
      ThesisFigureKind{"6_1", divisionsFigure},
  };
  return kFigures;
}

}  // namespace pleinair::app
