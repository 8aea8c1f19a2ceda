// The words by which files and people name the alternatives of an enumeration; each folder has those of
// its own.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace alphadot {

template <class E>
struct Word {
  std::string_view text;
  E value;
};

/// Every word of an enumeration, in the order shown to the user: specialised beside it.
template <class E>
inline constexpr std::span<const Word<E>> words_of = {};

/// The word for `value`, e.g. word_of(MotionKind::plunge) == "plunge".
template <class E>
std::string word_of(E value) {
  for (const auto& word : words_of<E>)
    if (word.value == value) return std::string(word.text);
  return "?";
}

/// The value that `text` names, if any.
template <class E>
std::optional<E> named_by(std::string_view text) {
  for (const auto& word : words_of<E>)
    if (word.text == text) return word.value;
  return std::nullopt;
}

}  // namespace alphadot
