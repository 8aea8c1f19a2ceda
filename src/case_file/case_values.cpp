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

}  // namespace alphadot
