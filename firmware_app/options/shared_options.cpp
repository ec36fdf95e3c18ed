#include "firmware_app/options/shared_options.h"

#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "config/profiles.h"
#include "config/suggestion.h"
#include "firmware_app/cli/option_values.h"

namespace pleinair::app {

CLI::Option* addKey(CLI::App& command, ConfigurationRequest& request, const std::string& option,
                    const std::string& key, const std::string& help, const std::string& type) {
  return command
      .add_option_function<std::string>(
          option,
          [&request, option, key](const std::string& text) {
            request.options.push_back({key, text, option});
          },
          help)
      ->type_name(type);
}

void addConfiguration(CLI::App& command, ConfigurationRequest& request) {
  command
      .add_option("--profile", request.profile,
                  fmt::format("the base configuration: {}, or a file (.toml)",
                              config::listText(config::profileNames())))
      ->type_name("NAME|FILE");
  command
      .add_option("--config", request.siteFile,
                  fmt::format("the site file (default: ${}, else {} if it exists)",
                              "PLEINAIR_CONFIG", request.defaultSiteFile.string()))
      ->type_name("FILE");
  command
      .add_option("--set", request.set,
                  "a parameter of the style, such as cell_size=12, or any other key, such as "
                  "camera.rate=15; `pleinair config` lists them")
      ->type_name("NAME=VALUE")
      ->take_all();
}

void addPainting(CLI::App& command, ConfigurationRequest& request) {
  addKey(command, request, "--style", "painting.style", "the style; `pleinair styles` lists them",
         "NAME");
  addKey(command, request, "--look", "painting.look",
         "a preset of the style's parameters, or a look file (.toml)", "NAME|FILE");
  addKey(command, request, "--view", "painting.view", "a debug view instead of the finished image",
         "NAME");
  addKey(command, request, "--scene", "painting.scene", "tags and models (TOML)", "FILE");
  addConfiguration(command, request);
}

CLI::Option* addFrames(CLI::App& command, std::function<void(std::uint64_t)> assign,
                       const std::string& help) {
  return command
      .add_option_function<std::string>(
          "--frames",
          [assign = std::move(assign)](const std::string& text) { assign(frameCountOf(text)); },
          help)
      ->type_name("N");
}

void addStyles(CLI::App& command, std::vector<std::string>& styles) {
  command
      .add_option("--style", styles, "only these styles; may be given several times (default: all)")
      ->allow_extra_args(false)
      ->type_name("NAME");
}

void addBoard(CLI::App& command, BoardOption& board, bool isRequired) {
  command
      .add_option("--board", board.kind,
                  "checkerboard:COLUMNSxROWS (inner corners) or aprilgrid:COLUMNSxROWS (tags)")
      ->required(isRequired)
      ->type_name("KIND:CxR");
  command.add_option("--square", board.square, "side of a checkerboard's square")
      ->type_name("METRES");
  command.add_option("--tag-edge", board.tagEdge, "edge of an aprilgrid's tag, the black square")
      ->type_name("METRES");
  command
      .add_option("--spacing", board.spacing,
                  "gap between tags, as a share of a tag's edge (default: 0.3)")
      ->type_name("SHARE");
  command.add_option("--first-id", board.firstId, "id of the lower left tag (default: 0)")
      ->type_name("ID");
}

}  // namespace pleinair::app
