// The types of value that a key of the case file can have: each reads a TOML node into a setting or says what
// is wrong with it, writes the setting as TOML, and describes itself.
#pragma once

#include <toml++/toml.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "case_file/case_keys.hpp"
#include "case_file/suggestion.hpp"
#include "core/error.hpp"
#include "core/words.hpp"
#include "derivatives/case.hpp"
#include "io/toml_text.hpp"

namespace alphadot {

using MaybeProblem = std::optional<Problem>;

/// "must be <expected>, not <the node>", e.g. "must be a number from 0.01 to 100, not "fast"".
MaybeProblem wrong_value(const std::string& expected, const toml::node& node);

/// A finite number within limits; integers are taken as well.
struct NumberValue {
  static constexpr bool is_text = false;
  Real from, to;

  std::string type() const;
  MaybeProblem read(const toml::node& node, Real& value) const;
  std::string write(Real value) const;
};

struct IntegerValue {
  static constexpr bool is_text = false;
  int from, to;

  std::string type() const;
  MaybeProblem read(const toml::node& node, int& value) const;
  std::string write(int value) const { return std::to_string(value); }
};

struct FlagValue {
  static constexpr bool is_text = false;
  std::string type() const { return "true or false"; }
  MaybeProblem read(const toml::node& node, bool& value) const;
  std::string write(bool value) const { return value ? "true" : "false"; }
};

/// Text without NUL, which would cut a file's name short.
struct TextValue {
  static constexpr bool is_text = true;
  std::size_t most = 4096;  ///< bytes
  bool may_be_empty = false;

  std::string type() const;
  MaybeProblem read(const toml::node& node, std::string& value) const;
  std::string write(const std::string& value) const { return toml_string(value); }
};

/// A list of texts.
struct TextsValue {
  static constexpr bool is_text = false;
  std::size_t most = 1;  ///< texts

  std::string type() const;
  MaybeProblem read(const toml::node& node, std::vector<std::string>& value) const;
  std::string write(const std::vector<std::string>& value) const;
};

/// Three numbers within limits, [x, y, z].
struct VectorValue {
  static constexpr bool is_text = false;
  Real from, to;

  std::string type() const;
  MaybeProblem read(const toml::node& node, Vec3& value) const;
  std::string write(const Vec3& value) const;
};

/// Controls, [{name, patches, hinge = {point, axis}}, ...].
struct ControlsValue {
  static constexpr bool is_text = false;
  std::size_t most = 1000;

  std::string type() const;
  MaybeProblem read(const toml::node& node, std::vector<ControlSettings>& value) const;
  std::string write(const std::vector<ControlSettings>& value) const;
};

/// Numbers by name, {name = number, ...}.
struct SharesValue {
  static constexpr bool is_text = false;
  Real from, to;

  std::string type() const;
  MaybeProblem read(const toml::node& node, std::map<std::string, Real>& value) const;
  std::string write(const std::map<std::string, Real>& value) const;
};

/// One of a list of words.
template <class E>
struct WordValue {
  static constexpr bool is_text = true;
  std::span<const Word<E>> words;

  std::string type() const {
    std::string out;
    for (const auto& word : words) out += (out.empty() ? "" : " | ") + toml_string(word.text);
    return out;
  }
  MaybeProblem read(const toml::node& node, E& value) const {
    const auto text = node.value_exact<std::string>();
    std::vector<std::string> candidates;
    for (const auto& word : words) {
      if (text == word.text) {
        value = word.value;
        return std::nullopt;
      }
      candidates.emplace_back(word.text);
    }
    auto problem = wrong_value(type(), node);
    const auto meant = text ? nearest(*text, candidates) : "";
    if (!meant.empty()) problem->remedy = "did you mean " + toml_string(meant) + "?";
    return problem;
  }
  std::string write(E value) const {
    for (const auto& word : words)
      if (word.value == value) return toml_string(word.text);
    return toml_string("?");
  }
};
template <class E>
WordValue(std::span<const Word<E>>) -> WordValue<E>;

/// Several of a list of words, each once.
template <class E>
struct WordsValue {
  static constexpr bool is_text = false;
  std::span<const Word<E>> words;

  std::string type() const { return "several of " + WordValue<E>{words}.type(); }
  MaybeProblem read(const toml::node& node, std::vector<E>& value) const {
    const auto* list = node.as_array();
    if (!list) return wrong_value(type(), node);
    value.clear();
    for (const auto& entry : *list) {
      E found{};
      if (auto problem = WordValue<E>{words}.read(entry, found)) return problem;
      if (std::ranges::find(value, found) != value.end())
        return Problem{"", 0, "names " + toml_string(word_of(found)) + " twice", "name each once"};
      value.push_back(found);
    }
    return std::nullopt;
  }
  std::string write(const std::vector<E>& value) const {
    std::string out;
    for (const E one : value) out += (out.empty() ? "" : ", ") + toml_string(word_of(one));
    return "[" + out + "]";
  }
};
template <class E>
WordsValue(std::span<const Word<E>>) -> WordsValue<E>;

/// A key whose value lives at `at(case)`.
template <class At, class ValueType>
CaseKey make_case_key(std::string path, At at, ValueType type, std::string doc) {
  CaseKey key;
  key.path = std::move(path);
  key.type = type.type();
  key.doc = std::move(doc);
  key.is_text = ValueType::is_text;
  if constexpr (requires { type.from; })
    key.limits = CaseKey::Limits{static_cast<Real>(type.from), static_cast<Real>(type.to)};
  key.read = [at, type](std::string_view, const toml::node& node, Case& c) { return type.read(node, at(c)); };
  key.write = [at, type, name = std::string(key.name())](const Case& c) {
    return name + " = " + type.write(at(c)) + "\n";
  };
  return key;
}

}  // namespace alphadot
