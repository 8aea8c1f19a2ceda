#include "case_file/case_values.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace alphadot {
namespace {

/// At most this much of a wrong text is repeated in a message.
constexpr std::size_t shown = 60;

std::string described(const toml::node& node) {
  if (const auto* text = node.as_string())
    return text->get().size() <= shown ? toml_string(text->get())
                                       : "a text of " + std::to_string(text->get().size()) + " bytes";
  if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (node.is_table()) return "a table";
  if (node.is_array()) return fmt::format("an array of {}", node.as_array()->size());
  return "a date or time";
}

/// The node as a number, integers included; NaN when it is neither.
Real number_of(const toml::node& node) {
  if (const auto* integer = node.as_integer()) return static_cast<Real>(integer->get());  // also a large one
  if (const auto* number = node.as_floating_point()) return number->get();
  return std::numeric_limits<Real>::quiet_NaN();
}

std::string written(Real value) {
  std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

}  // namespace

MaybeProblem wrong_value(const std::string& expected, const toml::node& node) {
  return Problem{"", 0, fmt::format("must be {}, not {}", expected, described(node)), ""};
}

std::string NumberValue::type() const {
  return fmt::format("a number from {} to {}", from, to);
}

MaybeProblem NumberValue::read(const toml::node& node, Real& value) const {
  const Real number = number_of(node);
  if (!(number >= from && number <= to)) return wrong_value(type(), node);
  value = number;
  return std::nullopt;
}

std::string NumberValue::write(Real value) const {
  return written(value);
}

std::string IntegerValue::type() const {
  return fmt::format("an integer from {} to {}", from, to);
}

MaybeProblem IntegerValue::read(const toml::node& node, int& value) const {
  const auto integer = node.value_exact<std::int64_t>();
  if (!integer || *integer < from || *integer > to) return wrong_value(type(), node);
  value = static_cast<int>(*integer);
  return std::nullopt;
}

MaybeProblem FlagValue::read(const toml::node& node, bool& value) const {
  const auto flag = node.value_exact<bool>();
  if (!flag) return wrong_value(type(), node);
  value = *flag;
  return std::nullopt;
}

std::string TextValue::type() const {
  return fmt::format("text of at most {} bytes", most);
}

MaybeProblem TextValue::read(const toml::node& node, std::string& value) const {
  const auto text = node.value_exact<std::string>();
  if (!text || text->size() > most) return wrong_value(type(), node);
  if (text->find('\0') != std::string::npos) return Problem{"", 0, "must not hold a NUL", ""};
  if (text->empty() && !may_be_empty) return Problem{"", 0, "must not be empty", ""};
  value = *text;
  return std::nullopt;
}

std::string TextsValue::type() const {
  return fmt::format("a list of at most {} texts", most);
}

MaybeProblem TextsValue::read(const toml::node& node, std::vector<std::string>& value) const {
  const auto* array = node.as_array();
  if (!array || array->size() > most) return wrong_value(type(), node);
  std::vector<std::string> texts(array->size());
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (auto problem = TextValue{}.read((*array)[i], texts[i])) return problem;
  value = std::move(texts);
  return std::nullopt;
}

std::string TextsValue::write(const std::vector<std::string>& value) const {
  std::string out;
  for (const auto& text : value) out += (out.empty() ? "" : ", ") + toml_string(text);
  return "[" + out + "]";
}

std::string VectorValue::type() const {
  return fmt::format("three numbers [x, y, z] from {} to {}", from, to);
}

MaybeProblem VectorValue::read(const toml::node& node, Vec3& value) const {
  const auto* array = node.as_array();
  if (!array || array->size() != 3) return wrong_value(type(), node);
  Vec3 vector;
  for (int i = 0; i < 3; ++i)
    if (auto problem = NumberValue{from, to}.read((*array)[static_cast<std::size_t>(i)], vector[i]))
      return problem;
  value = vector;
  return std::nullopt;
}

std::string VectorValue::write(const Vec3& value) const {
  return fmt::format("[{}, {}, {}]", written(value.x), written(value.y), written(value.z));
}

namespace {

/// Reads the keys of a table, all of which it must have and no others; says which one is wrong, where.
template <class... Readers>
MaybeProblem read_table(const toml::node& node, const std::string& expected,
                        const std::pair<std::string_view, Readers>&... keys) {
  const auto* table = node.as_table();
  const auto placed = [](const toml::node& at, Problem problem, std::string_view key) {
    if (problem.line == 0) problem.line = static_cast<int>(at.source().begin.line);
    if (!key.empty())
      problem.what = fmt::format("{}{}{}", key, problem.what.front() == '.' ? "" : ": ", problem.what);
    return problem;
  };
  if (!table) return placed(node, *wrong_value(expected, node), "");
  for (const auto& [key, value] : *table)
    if (((key.str() != keys.first) && ...))
      return placed(value,
                    {"", 0, fmt::format("{} is no key of it", toml_string(std::string(key.str()))),
                     "write " + expected},
                    "");
  MaybeProblem found;
  const auto read_one = [&](const auto& key) {
    if (found) return;
    const auto* value = table->get(key.first);
    if (!value)
      found = placed(node, {"", 0, fmt::format("{} is missing", key.first), "write " + expected}, "");
    else if (auto problem = key.second(*value))
      found = placed(*value, std::move(*problem), key.first);
  };
  (read_one(keys), ...);
  return found;
}

const std::string hinge_type = "{point = [x, y, z], axis = [x, y, z]}";
const std::string control_type = "a table with name, patches and hinge = " + hinge_type;
constexpr VectorValue point_value{-1e12, 1e12};

}  // namespace

std::string ControlsValue::type() const {
  return fmt::format("at most {} tables [[controls]], each {}", most, control_type);
}

MaybeProblem ControlsValue::read(const toml::node& node, std::vector<ControlSettings>& value) const {
  const auto* array = node.as_array();
  if (!array || array->size() > most) return wrong_value(type(), node);
  std::vector<ControlSettings> controls(array->size());
  for (std::size_t i = 0; i < controls.size(); ++i) {
    ControlSettings& control = controls[i];
    const auto read_name = [&](const toml::node& n) { return TextValue{.most = 60}.read(n, control.name); };
    const auto read_patches = [&](const toml::node& n) {
      return TextsValue{.most = 1000}.read(n, control.patches);
    };
    const auto read_hinge = [&](const toml::node& n) {
      return read_table(
          n, hinge_type,
          std::pair{std::string_view("point"),
                    [&](const toml::node& p) { return point_value.read(p, control.hinge_point); }},
          std::pair{std::string_view("axis"),
                    [&](const toml::node& a) { return point_value.read(a, control.hinge_axis); }});
    };
    auto problem = read_table((*array)[i], control_type, std::pair{std::string_view("name"), read_name},
                              std::pair{std::string_view("patches"), read_patches},
                              std::pair{std::string_view("hinge"), read_hinge});
    if (!problem) continue;
    problem->what = fmt::format(
        "{}: {}", control.name.empty() ? fmt::format("number {}", i + 1) : toml_string(control.name),
        problem->what);
    return problem;
  }
  value = std::move(controls);
  return std::nullopt;
}

std::string ControlsValue::write(const std::vector<ControlSettings>& value) const {
  std::string out;
  for (const auto& [name, patches, point, axis] : value)
    out += fmt::format("{}{{name = {}, patches = {}, hinge = {{point = {}, axis = {}}}}}",
                       out.empty() ? "" : ", ", toml_string(name), TextsValue{}.write(patches),
                       point_value.write(point), point_value.write(axis));
  return "[" + out + "]";
}

std::string SharesValue::type() const {
  return fmt::format("a table of shares from {} to {}, {{name = share, ...}}", from, to);
}

MaybeProblem SharesValue::read(const toml::node& node, std::map<std::string, Real>& value) const {
  const auto* table = node.as_table();
  if (!table) return wrong_value(type(), node);
  std::map<std::string, Real> shares;
  for (const auto& [key, number] : *table)
    if (auto problem = NumberValue{from, to}.read(number, shares[std::string(key.str())])) {
      problem->what = fmt::format("{} {}", toml_string(std::string(key.str())), problem->what);
      return problem;
    }
  value = std::move(shares);
  return std::nullopt;
}

std::string SharesValue::write(const std::map<std::string, Real>& value) const {
  std::string out;
  for (const auto& [name, number] : value)
    out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", toml_string(name), written(number));
  return "{" + out + "}";
}

}  // namespace alphadot
