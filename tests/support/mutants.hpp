// Damaged files, the same in every run and with every library.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>

namespace alphadot::testing_support {

using Random = std::mt19937;

/// Some place in [0, size); the modulo, unlike a distribution, gives the same with every library.
inline std::size_t below(std::size_t size, Random& random) {
  return random() % size;
}

/// Changes `content` in one way: bits, bytes, numbers or whole stretches.
inline void damage(std::string& content, Random& random) {
  if (content.empty()) return;
  const std::size_t place = below(content.size(), random);
  const std::size_t length = std::min(content.size() - place, 1 + below(40, random));
  switch (below(7, random)) {
    case 0:
      content[place] = static_cast<char>(content[place] ^ (1 << below(8, random)));
      break;
    case 1:
      content[place] = static_cast<char>(random());
      break;
    case 2:
      content.resize(place);
      break;
    case 3:
      content.erase(place, length);
      break;
    case 4:
      content.insert(place, content.substr(below(content.size(), random), length));
      break;
    case 5: {
      const char* const words[] = {
          " -1 ", " 2147483647 ", " 9223372036854775807 ", " 1e999 ", " nan ", "\n$Nodes\n", "="};
      const std::string word = words[below(std::size(words), random)];
      content.replace(place, std::min(length, word.size()), word);
      break;
    }
    case 6: {
      const std::int32_t values[] = {-1, 0, 0x7fffffff, -0x7fffffff - 1, 0x7ff00000};
      const std::int32_t value = values[below(std::size(values), random)];
      content.replace(place, std::min<std::size_t>(length, 4), reinterpret_cast<const char*>(&value), 4);
      break;
    }
  }
}

/// A mutant of `content`: damaged one to three times.
inline std::string mutant(std::string content, Random& random) {
  for (std::size_t times = 1 + below(3, random); times > 0; --times) damage(content, random);
  return content;
}

}  // namespace alphadot::testing_support
