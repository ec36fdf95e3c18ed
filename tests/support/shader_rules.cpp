#include "tests/support/shader_rules.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <regex>
#include <stdexcept>

namespace pleinair::support {
namespace {

constexpr long kMaxInvocations = 128;
constexpr long kMaxBindings = 4;
constexpr long kMaxOutputs = 4;
constexpr long kMaxSharedBytes = 16L * 1024;

enum class Stage { kVertex, kFragment, kCompute, kIncluded };

Stage stageOf(const ShaderText& shader) {
  if (shader.name.ends_with(".vert")) return Stage::kVertex;
  if (shader.name.ends_with(".frag")) return Stage::kFragment;
  return shader.name.ends_with(".comp") ? Stage::kCompute : Stage::kIncluded;
}

std::vector<std::smatch> allMatches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  return {std::sregex_iterator(text.begin(), text.end(), regex), std::sregex_iterator()};
}

long count(const std::string& text, const std::string& pattern) {
  return static_cast<long>(allMatches(text, pattern).size());
}

/// The code without comments and preprocessor lines.
std::string statements(std::string_view text) {
  return std::regex_replace(withoutComments(text), std::regex("(^|\n)[ \t]*#[^\n]*"), "$1");
}

Violations forbid(const std::string& code, const std::string& pattern, const std::string& why) {
  Violations violations;
  for (const std::smatch& match : allMatches(code, pattern)) {
    violations.push_back("\"" + match.str() + "\": " + why);
  }
  return violations;
}

void append(Violations& to, Violations from) {
  std::ranges::move(from, std::back_inserter(to));
}

/// Evaluates a constant expression by recursive descent.
class Evaluator {
 public:
  Evaluator(std::string_view expression, const std::string& code, int depth = 0)
      : code_(code), depth_(depth) {
    std::ranges::remove_copy_if(expression, std::back_inserter(rest_),
                                [](unsigned char c) { return std::isspace(c) != 0; });
    if (depth > 8) fail();
  }
  long all() {
    const long value = sum();
    if (at_ != rest_.size()) fail();
    return value;
  }

 private:
  [[noreturn]] void fail() const {
    throw std::invalid_argument("\"" + rest_ + "\" is no constant that this test can work out");
  }
  bool take(char c) {
    if (at_ >= rest_.size() || rest_[at_] != c) return false;
    ++at_;
    return true;
  }
  long sum() {
    long value = product();
    for (;;) {
      if (take('+')) {
        value += product();
      } else if (take('-')) {
        value -= product();
      } else {
        return value;
      }
    }
  }
  long product() {
    long value = atom();
    for (;;) {
      if (take('*')) {
        value *= atom();
      } else if (take('/')) {
        const long divisor = atom();
        if (divisor == 0) fail();
        value /= divisor;
      } else {
        return value;
      }
    }
  }
  long atom() {
    if (take('(')) {
      const long value = sum();
      if (!take(')')) fail();
      return value;
    }
    std::string word;
    while (at_ < rest_.size() &&
           (std::isalnum(static_cast<unsigned char>(rest_[at_])) != 0 || rest_[at_] == '_')) {
      word += rest_[at_++];
    }
    if (word.empty()) fail();
    if (std::isdigit(static_cast<unsigned char>(word.front())) != 0)
      return std::stol(word, nullptr, 0);
    std::smatch match;
    if (std::regex_search(code_, match,
                          std::regex("const\\s+u?int\\s+" + word + "\\s*=\\s*([^;]+);")) ||
        std::regex_search(code_, match, std::regex("#define[ \t]+" + word + "[ \t]+([^\n]+)"))) {
      return Evaluator(match[1].str(), code_, depth_ + 1).all();
    }
    fail();
  }

  std::string rest_;
  const std::string& code_;
  std::size_t at_ = 0;
  int depth_;
};

long bytesOfType(const std::string& type, const std::string& code);

/// The size in bytes of the variables that "float a[4], b" declares.
long bytesOfDeclaration(const std::string& type, const std::string& names,
                        const std::string& code) {
  long bytes = 0;
  for (const std::smatch& variable : allMatches(names, "\\w+\\s*((?:\\[[^\\]]*\\]\\s*)*)(?:,|$)")) {
    long elements = 1;
    const std::string dimensions = variable[1].str();
    for (const std::smatch& dimension : allMatches(dimensions, "\\[([^\\]]*)\\]")) {
      elements *= constantValue(dimension[1].str(), code);
    }
    bytes += elements * bytesOfType(type, code);
  }
  return bytes;
}

long bytesOfType(const std::string& type, const std::string& code) {
  static const std::map<std::string, long> kBytes{
      {"float", 4},  {"int", 4},   {"uint", 4},   {"bool", 4},   {"vec2", 8},  {"ivec2", 8},
      {"uvec2", 8},  {"vec3", 16}, {"ivec3", 16}, {"uvec3", 16}, {"vec4", 16}, {"ivec4", 16},
      {"uvec4", 16}, {"mat2", 16}, {"mat3", 48},  {"mat4", 64}};
  if (const auto known = kBytes.find(type); known != kBytes.end()) return known->second;
  std::smatch definition;
  if (!std::regex_search(code, definition, std::regex("struct\\s+" + type + "\\s*\\{([^}]*)\\}"))) {
    throw std::invalid_argument("nobody knows how large a " + type + " is");
  }
  long bytes = 0;
  const std::string members = definition[1].str();
  for (const std::smatch& member :
       allMatches(members, "(?:(?:highp|mediump)\\s+)?(\\w+)\\s+([^;]+);")) {
    bytes += bytesOfDeclaration(member[1].str(), member[2].str(), code);
  }
  return bytes;
}

const char* const kImageType = "\\b[iu]?image(?:2D|3D|Cube|2DArray|CubeArray|Buffer)\\b";

}  // namespace

std::string withoutComments(std::string_view text) {
  return std::regex_replace(std::string(text), std::regex("//[^\n]*|/\\*(?:[^*]|\\*(?!/))*\\*/"),
                            " ");
}

long constantValue(std::string_view expression, const std::string& code) {
  return Evaluator(expression, code).all();
}

Violations headCommentRule(const ShaderText& shader) {
  std::smatch match;
  std::string head;
  if (std::regex_search(shader.written, match, std::regex("^(?:[ \t]*//[^\n]*\n)+")))
    head = match.str();
  std::ranges::transform(head, head.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  Violations violations;
  for (const char* part : {"purpose:", "inputs", "outputs", "precision:"}) {
    if (head.find(part) == std::string::npos) {
      violations.push_back("the head comment (the // lines that the file begins with) lacks \"" +
                           std::string(part) + "\"");
    }
  }
  return violations;
}

Violations languageRule(const ShaderText& shader) {
  const std::string code = withoutComments(shader.expanded);
  Violations violations = forbid(code, "#\\s*version", "the shader library puts the version");
  append(violations, forbid(code, "#\\s*(?:if|elif)\\b",
                            "a program's inputs are found by #ifdef, #ifndef and #else alone"));
  append(violations,
         forbid(code,
                "\\b(?:gl_PrimitiveID(?:In)?|EmitVertex|EndPrimitive|gl_TessCoord|gl_TessLevel\\w+|"
                "gl_InvocationID)\\b",
                "geometry, tessellation and primitive ids are not on every target (rule 1)"));
  append(violations,
         forbid(shader.name, "\\.(?:geom|tesc|tese)$", "no such stage on every target"));
  return violations;
}

Violations graphicsStageRule(const ShaderText& shader) {
  const Stage stage = stageOf(shader);
  if (stage != Stage::kVertex && stage != Stage::kFragment) return {};
  const std::string code = statements(shader.expanded);
  const std::string why = "storage belongs in compute shaders (rules 2 and 3)";
  Violations violations = forbid(code, "\\bbuffer\\s+\\w+\\s*\\{", why);
  append(violations, forbid(code, kImageType, why));
  return violations;
}

Violations outputsRule(const ShaderText& shader) {
  if (stageOf(shader) != Stage::kFragment) return {};
  long outputs = 0;
  const std::string code = statements(shader.expanded);
  for (const std::smatch& output : allMatches(
           code,
           "(?:^|[;}])\\s*(?:layout\\s*\\([^)]*\\)\\s*)?(?:(?:highp|mediump|lowp|flat)\\s+)*out\\s+"
           "(?:(?:highp|mediump|lowp)\\s+)?\\w+\\s+\\w+\\s*(?:\\[([^\\]]*)\\]\\s*)?(?=;)")) {
    outputs += output[1].matched ? constantValue(output[1].str(), shader.expanded) : 1;
  }
  if (outputs <= kMaxOutputs) return {};
  return {std::to_string(outputs) + " colour targets; 4 are on every target (rule 3)"};
}

Violations computeLimitsRule(const ShaderText& shader) {
  if (stageOf(shader) != Stage::kCompute) return {};
  const std::string code = statements(shader.expanded);
  Violations violations;
  const auto sizes = allMatches(code, "local_size_[xyz]\\s*=\\s*([^,)]+)");
  long invocations = 1;
  for (const std::smatch& size : sizes) {
    invocations *= constantValue(size[1].str(), withoutComments(shader.expanded));
  }
  if (sizes.empty()) violations.emplace_back("no local_size");
  if (invocations > kMaxInvocations) {
    violations.push_back("groups of " + std::to_string(invocations) +
                         "; 128 invocations are on every target (rule 4)");
  }
  const long buffers = count(code, "\\bbuffer\\s+\\w+\\s*\\{");
  if (buffers > kMaxBindings) {
    violations.push_back(std::to_string(buffers) +
                         " storage buffers; 4 are on every target (rule 4)");
  }
  const long images = count(code, std::string("\\buniform\\b[^;(){}]*") + kImageType);
  if (images > kMaxBindings) {
    violations.push_back(std::to_string(images) + " images; 4 are on every target (rule 4)");
  }
  return violations;
}

Violations sharedMemoryRule(const ShaderText& shader) {
  const std::string code = statements(shader.expanded);
  const std::string constants = withoutComments(shader.expanded);
  long bytes = 0;
  for (const std::smatch& declaration :
       allMatches(code, "\\bshared\\s+(?:(?:highp|mediump|lowp)\\s+)?(\\w+)\\s+([^;]+);")) {
    bytes += bytesOfDeclaration(declaration[1].str(), declaration[2].str(), constants);
  }
  if (bytes <= kMaxSharedBytes) return {};
  return {std::to_string(bytes) + " bytes of shared memory; 16384 are on every target (rule 4)"};
}

Violations imageFormatsRule(const ShaderText& shader) {
  const std::string code = statements(shader.expanded);
  Violations violations =
      forbid(code, "\\bimageAtomic\\w+", "atomics live in storage buffers (rule 6)");
  const std::regex allowed("\\b(?:rgba8|rgba16f|rgba32f|r32f|r32ui)\\b");
  const std::regex readWrite("\\b(?:r32f|r32ui)\\b");
  const std::regex oneWay("\\b(?:readonly|writeonly)\\b");
  for (const std::smatch& match : allMatches(
           code, std::string("(?:layout\\s*\\([^)]*\\)\\s*)?[\\w \t]*\\buniform\\b[^;(){}]*") +
                     kImageType + "\\s*\\w+")) {
    const std::string image = match.str();
    if (!std::regex_search(image, allowed)) {
      violations.push_back("\"" + image + "\": its format is not on every target (rule 6)");
    } else if (!std::regex_search(image, oneWay) && !std::regex_search(image, readWrite)) {
      violations.push_back("\"" + image + "\": only r32f and r32ui are read and written (rule 6)");
    }
  }
  return violations;
}

Violations atomicOrderRule(const ShaderText& shader) {
  const std::string code = statements(shader.expanded);
  Violations violations;
  for (const std::smatch& match : allMatches(
           code, "(\\w+|\\S)?\\s*\\batomic(?:Add|CounterIncrement|CounterDecrement)\\s*\\(")) {
    // The operation's result is unused if it is a statement of its own.
    static constexpr std::array<std::string_view, 6> kStatementAfter{"",  ";", "{",
                                                                     "}", ")", "else"};
    if (std::ranges::find(kStatementAfter, match[1].str()) == kStatementAfter.end()) {
      violations.push_back("\"" + match.str() +
                           "\": its result is an order that changes from run to run (rule 7)");
    }
  }
  return violations;
}

Violations listEndRule(const ShaderText& shader) {
  const std::string code = statements(shader.expanded);
  static const std::regex kReadsList("\\b(?:busyAt|nearAt)\\s*\\(\\s*int\\s*\\(\\s*gl_WorkGroupID");
  static const std::regex kReturns(
      "void\\s+main\\s*\\(\\s*\\)\\s*\\{\\s*if\\s*\\(\\s*isBeyond\\s*\\(");
  if (!std::regex_search(code, kReadsList) || std::regex_search(code, kReturns)) return {};
  return {
      "main() does not begin with \"if (isBeyond(…)) return\": it runs beyond its list (rule 27)"};
}

Violations precisionRule(const ShaderText& shader) {
  const std::string code = statements(shader.expanded);
  Violations violations = forbid(code, "\\blowp\\b", "colours need 8 bits and more (rule 8)");
  const std::regex colour("\\bmediump\\s+vec[34]\\s+\\w*(?:[cC]olou?r|[rR]gb)\\w*");
  for (const std::smatch& match : allMatches(code, "\\bmediump\\s+\\w+(?:\\s+\\w+)?")) {
    if (!std::regex_match(match.str(), colour)) {
      violations.push_back("\"" + match.str() +
                           "\": mediump is for colours, vec3 or vec4 named so (rule 8)");
    }
  }
  return violations;
}

Violations texturesRule(const ShaderText& shader) {
  constexpr long kMaxTextures = 16;
  const long textures =
      count(statements(shader.expanded), "\\buniform\\b[^;(){}]*\\b[iu]?sampler\\w+");
  if (stageOf(shader) == Stage::kIncluded || textures <= kMaxTextures) return {};
  return {std::to_string(textures) + " textures; 16 are on every target"};
}

Violations loopBoundsRule(const ShaderText& shader) {
  return forbid(statements(shader.expanded),
                "\\bfor\\s*\\([^;]*;[^;]*<=?\\s*(?:k[A-Z]\\w*|\\d+);[^)]*\\)\\s*\\{\\s*"
                "if\\s*\\([^)]*\\)\\s*break\\b",
                "compilers unroll a constant bound; use the count itself (rule 19)");
}

Violations shaderRules(const ShaderText& shader) {
  Violations violations;
  for (const auto rule : {headCommentRule, languageRule, graphicsStageRule, outputsRule,
                          computeLimitsRule, sharedMemoryRule, imageFormatsRule, atomicOrderRule,
                          listEndRule, precisionRule, texturesRule, loopBoundsRule}) {
    try {
      append(violations, rule(shader));
    } catch (const std::invalid_argument& unreadable) {
      violations.emplace_back(unreadable.what());
    }
  }
  return violations;
}

}  // namespace pleinair::support
