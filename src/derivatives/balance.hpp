// Where a configuration balances, from its derivatives.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/derivatives.hpp"
#include "analysis/table.hpp"
#include "motion/flight_condition.hpp"

namespace alphadot {

/// Static margin in reference lengths and neutral point, x in the reference's units, as rows of a table. Each
/// part of the uncertainty is that of the derivatives' same part.
std::vector<TableRow> balance_rows(const FlightCondition& settings, const EstimatedDerivatives& estimated);

/// The balance, and, with second rates, up to which reduced frequency the derivatives describe a plunge to
/// 1 %: names and values.
std::vector<std::pair<std::string, Real>> longitudinal_of(std::span<const TableRow> balance,
                                                          const DerivativeSet& derivatives);

}  // namespace alphadot
