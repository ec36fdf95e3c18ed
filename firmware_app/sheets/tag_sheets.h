#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware_app/sheets/printed_page.h"
#include "pipeline/calibration/board.h"

namespace pleinair::app {

/// A tag to be printed.
struct PrintedTag {
  std::string family;
  int id = 0;
  double edgeMetres = 0;  ///< of the black square, as in a scene
};

/// The paper of a name ("a4", "a3", "letter") or of a size in millimetres ("210x297"); nothing for
/// another text.
std::optional<PaperSize> paperOf(const std::string& text);

/// A PDF with the tags at their true sizes, as many on a page as there is room for, each with its
/// white border, marks to cut along, and its name; and rulers on each page. Throws hal::Failure
/// (kInvalidArgument) for a tag that does not fit on the paper, or that its family lacks.
std::vector<std::uint8_t> tagSheets(const std::vector<PrintedTag>& tags, PaperSize paper);

/// A PDF with a calibration board at its true size, turned where it fits so only. Throws as above.
std::vector<std::uint8_t> boardSheet(const calibration::Board& board, PaperSize paper);

}  // namespace pleinair::app
