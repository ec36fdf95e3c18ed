#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "firmware_app/cli/board_option.h"
#include "firmware_app/config/configuration.h"

namespace pleinair::app {

// Options that several subcommands have. All referenced objects must outlive the parsing.

/// Adds an option that sets a key of the configuration. The configuration validates the value.
CLI::Option* addKey(CLI::App& command, ConfigurationRequest& request, const std::string& option,
                    const std::string& key, const std::string& help, const std::string& type);

/// Adds the options that select the configuration's sources.
void addConfiguration(CLI::App& command, ConfigurationRequest& request);

/// Adds the options of [painting], for subcommands that paint, and addConfiguration()'s.
void addPainting(CLI::App& command, ConfigurationRequest& request);

CLI::Option* addFrames(CLI::App& command, std::function<void(std::uint64_t)> assign,
                       const std::string& help);

/// The options that describe a calibration board; --board is required where `isRequired`.
void addBoard(CLI::App& command, BoardOption& board, bool isRequired);

/// --style, as often as wanted, for subcommands that go through all styles.
void addStyles(CLI::App& command, std::vector<std::string>& styles);

}  // namespace pleinair::app
