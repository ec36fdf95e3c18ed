#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/config_error.h"
#include "hal/error.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::procedure {

inline constexpr std::string_view kProcedureFile = "procedure.toml";
inline constexpr std::size_t kMaxSteps = 500;
inline constexpr std::size_t kMaxLanguages = 20;

/// Whether the text is a language tag as procedures use them: "en", "pt-BR".
bool isLanguageTag(std::string_view text);

/// What a procedure's TOML refers to. Tests and the fuzz target replace the folder.
class ProcedureSources {
 public:
  virtual ~ProcedureSources() = default;
  /// The content of a text file of the folder; nothing if there is none.
  virtual hal::Result<std::string> text(const std::string& name) = 0;
  /// Whether a picture file can be shown; the error says why not.
  virtual hal::Result<void> picture(const std::string& name) = 0;
  /// The size of a movie that can be played; the error says why it cannot.
  virtual hal::Result<hal::FrameSize> movie(const std::string& name) = 0;
  virtual hal::Result<std::shared_ptr<const scene::Model>> model(
      const scene::ModelSource& source) = 0;
  /// Languages whose texts lie in the folder.
  virtual std::vector<std::string> languages() = 0;
  virtual std::filesystem::path folder() const = 0;
};

/// A procedure, and the mistakes in it. With mistakes, what is wrong is left out of the procedure,
/// which is then of no use but for messages.
struct ProcedureReading {
  Procedure procedure;
  std::vector<config::ConfigError> faults;
  std::vector<config::ConfigError>
      warnings;  ///< what is likely wrong, and keeps nothing from running
};

// clang-format off
/// Reads a procedure. All that its TOML may hold (docs/repair-station.md):
///
///     name = "change-bearing"
///     version = "1.0"
///     languages = ["en", "de"]       # each has its texts in LANGUAGE.md
///     [model]
///     source = "machine.glb"         # or a built-in model, with its keys as in a scene file
///     units = "mm"                   # of a file that is not in metres; STL and OBJ need it
///     up = "z"                       # where it is not as usual: glTF and OBJ y, STL z
///     [tools]
///     hex_5 = { en = "5 mm hex key", de = "Innensechskant 5 mm" }
///     [warnings]
///     hot_oil = { level = "caution", en = "Hot oil", de = "Heißes Öl" }
///     [[step]]
///     id = "drain"
///     parts = ["oil_plug"]           # in focus: nodes of the model; "bolt_*" is all that begin so
///     removes = ["oil_plug"]         # off after this step; fits = […] puts them back
///     tools = ["hex_5"]
///     warnings = ["hot_oil"]
///     motion = "unscrew"             # the arrow: pull, push, turn, screw, unscrew, none
///     axis = "-y"                    # of its parts' own axes: along or around it they move
///     show = { cover = "tint" }      # plain, focus, tint, outline, hidden, ghost
///     apart = { cover = 0.1 }        # also shown that far (metres) along the axis
///     torque = "20 ± 2 Nm"
///     movie = "unscrew.mp4"          # without sound, 15 s at most, again and again
///     check = { kind = "value", unit = "mm", min = 0.1, max = 0.3 }
///     goto = { low = "measure", high = "end" }
///     next = "refill"                # default: the next step of the file
///
/// Never throws for mistakes: all are listed, in the order of the files.
ProcedureReading readProcedure(std::string_view toml, const std::string& name,
                               ProcedureSources& sources);
// clang-format on

/// Reads the procedure of a folder, with its files and hash. Mistakes are listed; a folder without
/// procedure.toml is one.
ProcedureReading readProcedureFolder(const std::filesystem::path& folder);

/// The same; throws the first mistake as a config::ConfigError.
Procedure loadProcedure(const std::filesystem::path& folder);

}  // namespace pleinair::procedure
