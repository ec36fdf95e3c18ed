#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware_app/cli/option_values.h"
#include "firmware_app/options/shared_options.h"
#include "firmware_app/options/subcommands.h"
#include "firmware_app/sheets/tag_sheets.h"

namespace pleinair::app {
namespace {

/// "0-3,7": 0, 1, 2, 3 and 7.
std::vector<int> idsOf(const std::string& text) {
  constexpr std::size_t kMostTags = 1000;
  std::vector<int> ids;
  const auto refuse = [&text] {
    return CLI::ValidationError(
        "--ids", fmt::format("found \"{}\", allowed: numbers and ranges such as 0-3,7", text));
  };
  const auto numberIn = [&](std::string_view digits) {
    int number = -1;
    const auto [end, status] =
        std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (status != std::errc() || end != digits.data() + digits.size() || number < 0) throw refuse();
    return number;
  };
  for (std::string_view rest = text; !rest.empty() || ids.empty();) {
    const std::string_view part = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(part.size() + 1, rest.size()));
    const std::size_t dash = part.find('-');
    const int first = numberIn(part.substr(0, dash));
    const int last = dash == std::string_view::npos ? first : numberIn(part.substr(dash + 1));
    if (last < first) throw refuse();
    for (int id = first; id <= last; ++id) {
      ids.push_back(id);
      if (ids.size() > kMostTags) throw refuse();
    }
  }
  return ids;
}

}  // namespace

void addTags(CLI::App& app, TagsOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand(
      "tags", "print tags or a calibration board at their true size, as a PDF with rulers");
  command.add_option("--sheet", options.sheet, "the PDF")
      ->required()
      ->check(requirePdfName)
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--paper",
          [&options](const std::string& text) {
            const auto paper = paperOf(text);
            if (!paper) {
              throw CLI::ValidationError(
                  "--paper", fmt::format("found \"{}\", allowed: a4, a3, a2, letter, tabloid, or "
                                         "WIDTHxHEIGHT in millimetres",
                                         text));
            }
            options.paper = *paper;
          },
          "a4 (default), a3, a2, letter, tabloid, or WIDTHxHEIGHT in millimetres")
      ->type_name("NAME");
  CLI::Option* ids =
      command
          .add_option_function<std::string>(
              "--ids", [&options](const std::string& text) { options.ids = idsOf(text); },
              "the tags, such as 0-3,7 (default: 0)")
          ->type_name("LIST");
  CLI::Option* family =
      command.add_option("--family", options.family, "their family (default: tag36h11)")
          ->type_name("NAME");
  CLI::Option* edge = command
                          .add_option_function<std::string>(
                              "--edge",
                              [&options](const std::string& text) {
                                options.edgeMetres = numberOf("--edge", text, "m", 0.002, 3.0);
                              },
                              "edge of their black squares in metres (default: 0.12)")
                          ->type_name("METRES");
  CLI::Option* scene =
      command.add_option("--scene", options.scene, "a scene file, whose tags are printed")
          ->type_name("FILE");
  options.board.emplace();
  addBoard(command, *options.board, false);
  CLI::Option* board = command.get_option("--board");
  for (CLI::Option* each : {ids, family, edge}) each->excludes(scene)->excludes(board);
  scene->excludes(board);
  for (const char* each : {"--square", "--tag-edge", "--spacing", "--first-id"}) {
    command.get_option(each)->needs(board);
  }
  refuseEmptyValues(command);
  command.callback([&options, &chosen, board] {
    if (board->count() == 0) options.board.reset();
    chosen = [&options] { return printTags(options); };
  });
}

}  // namespace pleinair::app
