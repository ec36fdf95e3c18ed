#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace pleinair::gpu {

/// A name that a shader's text declares for the program to fill.
struct ShaderInput {
  enum class Kind { kUniform, kSampler, kImage, kUniformBlock, kStorageBlock };

  Kind kind = Kind::kUniform;
  std::string name;
  std::string type;  ///< GLSL's, such as "vec2"; of a block empty
  int binding = -1;  ///< of images and blocks, as `layout(binding = …)` says; -1 without one
};

/// Follows the conditions of a text, line by line: `#define`, `#undef`, `#ifdef`, `#ifndef`,
/// `#else` and `#endif`. Both sides of an `#if` count as read, which no shader of the tree uses.
class ShaderConditions {
 public:
  /// Takes the next line; whether a compiler would read it, directives of conditions apart.
  bool reads(std::string_view line);

 private:
  std::set<std::string> macros_;
  std::vector<bool> branches_;  // whether the side of each open condition is read
};

/// The lines of a text that a compiler would read, by its ShaderConditions; other lines are left
/// empty, so that lines keep their numbers.
std::string activeLines(std::string_view text);

/// Everything that the text (without unresolved includes) declares at its top level. A binding that
/// is neither a number nor a `const int` of the text counts as none.
std::vector<ShaderInput> declaredInputs(std::string_view text);

}  // namespace pleinair::gpu
