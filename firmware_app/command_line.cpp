#include "firmware_app/command_line.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <ctime>
#include <functional>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "config/suggestion.h"
#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/memory_limit.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/config/renamed.h"
#include "firmware_app/service_manager/journal_stream.h"
#include "firmware_app/subcommand_options.h"
#include "firmware_app/version.h"
#include "pipeline/gpu/context/shared_displays.h"

namespace pleinair::app {

namespace {

/// The level as syslog(3) numbers it: "<4>".
class SyslogLevel final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& line) override {
    const std::string_view text = levelOf(message.level);
    line.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<SyslogLevel>();
  }

 private:
  static std::string_view levelOf(spdlog::level::level_enum level) {
    switch (level) {
      case spdlog::level::critical:
        return "<2>";
      case spdlog::level::err:
        return "<3>";
      case spdlog::level::warn:
        return "<4>";
      case spdlog::level::info:
        return "<6>";
      default:
        return "<7>";
    }
  }
};

}  // namespace

void logToStandardError() {
  auto logger = std::make_shared<spdlog::logger>("pleinair",
                                                 std::make_shared<spdlog::sinks::stderr_sink_mt>());
  if (isJournalStream(STDERR_FILENO)) {
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<SyslogLevel>('*').set_pattern("%*%v");
    logger->set_formatter(std::move(formatter));
  } else {
    logger->set_pattern("pleinair: %l: %v");
  }
  spdlog::set_default_logger(std::move(logger));
}

namespace {

/// How a recording or a camera is given to a command that was given it otherwise; empty where
/// nothing better is known. `option` is empty for an argument without one.
std::string misplacedText(const CLI::App& command, const std::string& option,
                          const std::string& argument) {
  const std::string& name = command.get_name();
  const bool hasInput = command.get_option_no_throw("--input") != nullptr;
  const bool hasCamera = command.get_option_no_throw("--camera") != nullptr;
  if (option.empty() && hasInput) {
    return fmt::format("{}: unexpected argument: give a recording as --input FILE", argument);
  }
  if ((option.empty() || option == "--input") && hasCamera && !hasInput) {
    const std::string found = option.empty() ? argument + ": unexpected argument" : option;
    return fmt::format(
        "{}: `pleinair {}` takes a camera or a recording as --camera NAME|FILE; `pleinair render "
        "FILE` paints every frame of a recording",
        found, name);
  }
  if (option == "--camera" && hasInput) {
    return fmt::format(
        "--camera: `pleinair {}` takes a recording, as FILE; `pleinair run` paints a camera, "
        "`pleinair record` records one",
        name);
  }
  return {};
}

/// The error text for unknown arguments. It names the first unknown option, if any: the other
/// arguments may be its value.
std::string unknownText(const CLI::App& app, const std::vector<std::string>& unknown) {
  const auto option =
      std::ranges::find_if(unknown, [](const std::string& text) { return text.starts_with('-'); });
  const std::string word = option == unknown.end() ? unknown.front() : *option;
  const std::string name = word.substr(0, word.find('='));
  const std::vector<CLI::App*> commands = app.get_subcommands();
  std::vector<std::string> known;
  if (option != unknown.end()) {
    if (const auto now = renamedOption(name)) return fmt::format("{} is now {}", name, *now);
    if (!commands.empty()) {
      if (std::string text = misplacedText(*commands.front(), name, word); !text.empty()) {
        return text;
      }
    }
    for (const CLI::Option* each : (commands.empty() ? app : *commands.front()).get_options()) {
      known.push_back(each->get_name());
    }
    return fmt::format("{}: {}", name, config::unknownText("option", name, known));
  }
  if (!commands.empty()) {
    const std::string text = misplacedText(*commands.front(), "", word);
    return text.empty() ? fmt::format("{}: unexpected argument", word) : text;
  }
  for (const CLI::App* each : app.get_subcommands({})) known.push_back(each->get_name());
  return fmt::format("{}: {}", word, config::unknownText("command", word, known));
}

/// Prints CLI11's message on one line and gives pleinair's exit status.
int reportParseError(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
  // CLI11 would report a missing --input if the user typed "--inpt".
  const std::vector<std::string> unknown = app.remaining(true);
  const bool isAboutUnknown = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr ||
                              dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const std::string text =
      isAboutUnknown && !unknown.empty() ? unknownText(app, unknown) : error.what();
  std::string path;
  for (auto within = app.get_subcommands(); !within.empty();
       within = within.front()->get_subcommands()) {
    path += within.front()->get_name() + " ";
  }
  printError(fmt::format("{}; see pleinair {}--help", text, path));
  return static_cast<int>(ExitStatus::kUsage);
}

/// Gives `status`, or kUsage if standard output could not be written.
int withOutputFlushed(int status) {
  errno = 0;
  std::cout.flush();  // CLI11's help
  const bool arrived = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good();
  if (arrived || status != 0) return status;
  if (errno == 0) {  // an earlier write failed and its errno is lost: try again
    std::clearerr(stdout);
    std::fputc('\n', stdout);
    std::fflush(stdout);
  }
  if (errno == EPIPE) return status;  // the reader, such as `head`, has had enough
  const std::string cause = errno == 0 ? "" : ": " + std::generic_category().message(errno);
  printError("standard output: cannot write" + cause);
  return static_cast<int>(ExitStatus::kUsage);
}

/// The arguments in CLI11's order, last first. Splits "--name=": CLI11 would take the next argument
/// for its value. "help render" becomes "render --help".
std::vector<std::string> argumentsReversed(int argc, const char* const* argv) {
  std::vector<std::string> arguments;
  for (const char* each :
       std::span(argv, static_cast<std::size_t>(argc)).subspan(argc > 0 ? 1 : 0)) {
    std::string argument = each;
    const bool hasEmptyValue =
        argument.starts_with("--") && argument.find('=') == argument.size() - 1;
    if (hasEmptyValue) argument.pop_back();
    arguments.push_back(std::move(argument));
    if (hasEmptyValue) arguments.emplace_back();
  }
  if (!arguments.empty() && arguments.front() == "help") {
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
  }
  std::ranges::reverse(arguments);
  return arguments;
}

int parseAndRun(int argc, const char* const* argv) {
  CLI::App app("pleinair paints live augmented-reality video with marks that stay put.",
               "pleinair");
  app.set_version_flag("--version", kVersion);
  constexpr std::size_t kNamesWidth = 36;
  app.get_formatter()->column_width(kNamesWidth);
  app.require_subcommand(0, 1);  // 0, because with 1 CLI11 would not report a wrong name
  SubcommandOptions options;
  std::function<int()> chosen;
  options.run.program = kVersion;
  addSubcommands(app, options, chosen);
  try {
    app.parse(argumentsReversed(argc, argv));
    if (!chosen)
      throw CLI::RequiredError(
          "one of run, rescue, render, record, looks, scene, tags, procedure, record-check, "
          "record-export, inputs, calibrate, measure, config, devices, doctor, warm-up, "
          "thesis and styles");
    return chosen();
  } catch (const CLI::ParseError& error) {
    return reportParseError(app, error);
  } catch (...) {
    return static_cast<int>(reportCurrentException());
  }
}

}  // namespace

int runCommandLine(int argc, const char* const* argv) {
  prepareStandardStreams();
  explainCrashesUnderAMemoryLimit();
  logToStandardError();
  const int status = withOutputFlushed(parseAndRun(argc, argv));
  gpu::terminateDisplays();
  return status;
}

}  // namespace pleinair::app
