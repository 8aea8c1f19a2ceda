#include "space/reconstruction.hpp"

#include <type_traits>

#include "core/prefetch.hpp"

namespace alphadot {

template <class T>
Reconstruction<T>::Reconstruction(const Discretization& discretization, const Communicator& comm)
    : discretization_(discretization),
      gradients_(discretization.domain(), comm, HaloWidth::faces),
      points_(static_cast<std::size_t>(discretization.domain().owned_points)),
      factors_(discretization.space().freeze_orders > 0
                   ? static_cast<std::size_t>(discretization.domain().owned_cells)
                   : 0) {}

template <class T>
void Reconstruction<T>::fit(const FlowField<T>& flow, Index point_begin, Index point_end, Index begin,
                            Index end) {
  gather_points<T>(discretization_, flow, point_begin, point_end, points_);
  switch (discretization_.space().limiter) {
    case LimiterKind::venkatakrishnan:
      return fit_limited<LimiterKind::venkatakrishnan>(flow, begin, end);
    case LimiterKind::mlp_u2:
      return fit_limited<LimiterKind::mlp_u2>(flow, begin, end);
    case LimiterKind::barth_jespersen:
      return fit_limited<LimiterKind::barth_jespersen>(flow, begin, end);
    case LimiterKind::none:
      return fit_limited<LimiterKind::none>(flow, begin, end);
  }
}

template <class T>
LimiterSlopes Reconstruction<T>::limiter_slopes(
    const FlowField<T>& flow) const requires std::is_same_v<T, Real> {
  const auto slopes = [&]<LimiterKind limiter>() {
    const Index owned = discretization_.domain().owned_cells;
    LimiterSlopes out(static_cast<std::size_t>(owned));
    if constexpr (!is_change<T>)  // Clang before 16 also instantiates what the constraint excludes
      for (Index cell = 0; cell < owned; ++cell)
        find_limiter_slope<limiter>(discretization_, points_, cell, flow, frozen_ ? &factors_[cell] : nullptr,
                                    out);
    return out;
  };
  switch (discretization_.space().limiter) {
    case LimiterKind::venkatakrishnan:
      return slopes.template operator()<LimiterKind::venkatakrishnan>();
    case LimiterKind::mlp_u2:
      return slopes.template operator()<LimiterKind::mlp_u2>();
    case LimiterKind::barth_jespersen:
      return slopes.template operator()<LimiterKind::barth_jespersen>();
    case LimiterKind::none:
      break;
  }
  return {};
}

template <class T>
template <LimiterKind limiter>
[[gnu::flatten]] void Reconstruction<T>::fit_limited(const FlowField<T>& flow, Index begin, Index end) {
  constexpr Index cells_ahead = 8;  // that the memory is asked for
  const Subdomain& domain = discretization_.domain();
  for (Index cell = begin; cell < end; ++cell) {
    if (const Index ahead = cell + cells_ahead; ahead < end)
      for (const Index point : domain.cell_points[ahead]) prefetch(points_[point]);
    const Primitive<T>& w = flow[cell];
    const Offsets offsets = offsets_of(domain, cell);
    Gradient<T> gradient = unlimited_gradient<T>(discretization_, points_, cell, offsets, w);
    if constexpr (is_change<T>) {
      if (slopes_ && !slopes_->empty()) follow_limiter<limiter>(*slopes_, cell, flow, offsets, gradient);
    } else if constexpr (limiter != LimiterKind::none) {
      Primitive<T> factor;
      if (frozen_) {
        for (int i = 0; i < 5; ++i) factor[i] = factors_[cell][i];
      } else {
        factor = alphadot::limiter_factors<limiter, T>(discretization_, points_, cell, offsets, w, gradient,
                                                       positivity_cells_);
        if (!factors_.empty())
          for (int i = 0; i < 5; ++i) factors_[cell][i] = static_cast<float>(value_of(factor[i]));
      }
      for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 5; ++i) gradient.along[axis][i] = factor[i] * gradient.along[axis][i];
    }
    gradients_[cell] = gradient;
  }
}

template <class T>
std::size_t Reconstruction<T>::bytes() const {
  return gradients_.bytes() + points_.size() * sizeof(points_[0]) + factors_.size() * sizeof(factors_[0]);
}

template class Reconstruction<Real>;
template class Reconstruction<Changes<1>>;
template class Reconstruction<Changes<2>>;
template class Reconstruction<Changes<3>>;
template class Reconstruction<Changes<4>>;

}  // namespace alphadot
