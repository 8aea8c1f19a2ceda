// The words by which a case file names the alternatives of an enumeration.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "io/case.hpp"

namespace alphadot {

template <class E>
struct Word {
  std::string_view text;
  E value;
};

/// Every word of an enumeration, in the order shown to the user.
template <class E>
inline constexpr std::span<const Word<E>> words_of = {};

namespace words {
inline constexpr Word<FluxKind> flux[] = {
    {"roe", FluxKind::roe}, {"van_leer", FluxKind::van_leer}, {"hllc", FluxKind::hllc}};
inline constexpr Word<GradientKind> gradient[] = {{"least_squares", GradientKind::least_squares},
                                                  {"green_gauss", GradientKind::green_gauss}};
inline constexpr Word<LimiterKind> limiter[] = {{"venkatakrishnan", LimiterKind::venkatakrishnan},
                                                {"mlp_u2", LimiterKind::mlp_u2},
                                                {"barth_jespersen", LimiterKind::barth_jespersen},
                                                {"none", LimiterKind::none}};
inline constexpr Word<SchemeKind> scheme[] = {{"lu_sgs", SchemeKind::lu_sgs},
                                              {"block_lu_sgs", SchemeKind::block_lu_sgs}};
inline constexpr Word<SensitivityMethod> sensitivity[] = {{"gmres", SensitivityMethod::gmres},
                                                          {"march", SensitivityMethod::march}};
inline constexpr Word<MotionKind> motion[] = {{"none", MotionKind::none},
                                              {"plunge", MotionKind::plunge},
                                              {"sway", MotionKind::sway},
                                              {"pitch", MotionKind::pitch},
                                              {"yaw", MotionKind::yaw},
                                              {"roll", MotionKind::roll},
                                              {"flap", MotionKind::flap},
                                              {"step_alpha", MotionKind::step_alpha},
                                              {"ramp_alpha", MotionKind::ramp_alpha},
                                              {"step_q", MotionKind::step_q},
                                              {"table", MotionKind::table}};
inline constexpr Word<TreatmentKind> treatment[] = {{"field_velocity", TreatmentKind::field_velocity},
                                                    {"rigid_grid", TreatmentKind::rigid_grid},
                                                    {"deforming_grid", TreatmentKind::deforming_grid}};
inline constexpr Word<BoundaryKind> boundary[] = {{"wall", BoundaryKind::wall},
                                                  {"sting", BoundaryKind::sting},
                                                  {"jet", BoundaryKind::jet},
                                                  {"symmetry", BoundaryKind::symmetry},
                                                  {"farfield", BoundaryKind::farfield}};
inline constexpr Word<FailureAction> failure[] = {{"stop", FailureAction::stop},
                                                  {"continue", FailureAction::go_on}};
/// reference.model: is the mesh the half y >= 0?
inline constexpr Word<bool> model[] = {{"full", false}, {"half", true}};
}  // namespace words

template <>
inline constexpr std::span<const Word<FluxKind>> words_of<FluxKind> = words::flux;
template <>
inline constexpr std::span<const Word<SensitivityMethod>> words_of<SensitivityMethod> = words::sensitivity;
template <>
inline constexpr std::span<const Word<GradientKind>> words_of<GradientKind> = words::gradient;
template <>
inline constexpr std::span<const Word<LimiterKind>> words_of<LimiterKind> = words::limiter;
template <>
inline constexpr std::span<const Word<SchemeKind>> words_of<SchemeKind> = words::scheme;
template <>
inline constexpr std::span<const Word<MotionKind>> words_of<MotionKind> = words::motion;
template <>
inline constexpr std::span<const Word<TreatmentKind>> words_of<TreatmentKind> = words::treatment;
template <>
inline constexpr std::span<const Word<FailureAction>> words_of<FailureAction> = words::failure;
template <>
inline constexpr std::span<const Word<BoundaryKind>> words_of<BoundaryKind> = words::boundary;

/// The word for `value`, e.g. word_of(MotionKind::plunge) == "plunge".
template <class E>
std::string word_of(E value) {
  for (const auto& word : words_of<E>)
    if (word.value == value) return std::string(word.text);
  return "?";
}

/// The value that `text` names, if any.
template <class E>
std::optional<E> value_of(std::string_view text) {
  for (const auto& word : words_of<E>)
    if (word.text == text) return word.value;
  return std::nullopt;
}

}  // namespace alphadot
