// Tables and exchange formats: what a reader or another program must find in the text.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <regex>
#include <sstream>
#include <string>

#include "analysis/avl.hpp"
#include "analysis/jsbsim.hpp"
#include "analysis/table.hpp"

namespace alphadot {
namespace {

/// A made-up missile at alpha = 2 deg; each entry of the derivatives has its own value, a column's six
/// entries being column + 0.1, + 0.2, ... + 0.6.
FlightPoint example() {
  FlightPoint point{.title = "example",
                    .reference = {.length = 2, .area = 3, .moment_center = {5.5, 0, 0}},
                    .freestream = {.mach = 2.5, .alpha = 2},
                    .steady = {.CA = 0.4, .CY = 0.01, .CN = 0.3, .Cl = 0.02, .Cm = -0.5, .Cn = 0.03},
                    .derivatives = {}};
  Real column = 0;
  for (const Variable variable : {Variable::alpha, Variable::beta, Variable::p, Variable::q, Variable::r,
                                  Variable::alphadot, Variable::betadot, Variable::q_plus_alphadot}) {
    column += 10;
    for (int i = 0; i < Coefficients::size(); ++i)
      point.derivatives[variable][i] = {column + 0.1 * (i + 1), 0.05};
  }
  return point;
}

bool contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(Table, SaysWhatItsNumbersReferTo) {
  const auto point = example();
  const auto table = derivative_table(rows_of(point.derivatives, "linear solve"), {point.reference});
  EXPECT_TRUE(contains(table, "length 2, area 3, moment centre and axis of rotation (5.5, 0, 0)"));
  EXPECT_TRUE(contains(table, "rates times length / 2V"));
  EXPECT_TRUE(contains(table, "body: CA aft, CY starboard, CN up"));
  // alphadot is the sixth column, Cm the fifth coefficient.
  EXPECT_TRUE(std::regex_search(table, std::regex("Cm_alphadot +60\\.5 ± 0\\.05 +linear solve"))) << table;
}

TEST(Table, RowsHaveTheNamesOfTheirAxes) {
  DerivativeSet derivatives = example().derivatives;
  EXPECT_EQ(rows_of(derivatives, "m", Axes::stability).front().name, "CD_alpha");
  EXPECT_EQ(rows_of(derivatives, "m").front().name, "CA_alpha");
  EXPECT_EQ(rows_of(derivatives, "m").size(), 48u);
  derivatives[Variable::alpha].CY = {0, 0};
  EXPECT_EQ(rows_of(derivatives, "m").size(), 47u) << "zero by symmetry";
}

// Reading the file back gives each number to the last bit.
TEST(Table, CsvKeepsFullPrecision) {
  const std::vector<TableRow> rows{{"Cm_alphadot", {-23.0 / 7, 1.0 / 3}, "plunge, k = 0.01"}};
  std::istringstream lines(derivative_csv(rows, {example().reference}));
  std::string line;
  int comments = 0;
  while (std::getline(lines, line) && line[0] == '#') ++comments;
  EXPECT_EQ(comments, 3);
  EXPECT_EQ(line, "name,value,uncertainty,method,converged,group");
  std::getline(lines, line);
  std::smatch words;
  ASSERT_TRUE(
      std::regex_match(line, words, std::regex("Cm_alphadot,([^,]+),([^,]+),\"plunge, k = 0.01\",yes,")))
      << line;
  EXPECT_EQ(std::stod(words[1]), -23.0 / 7);
  EXPECT_EQ(std::stod(words[2]), 1.0 / 3);
}

// Longitudinal, lateral, cross and controls; what is not told from zero is named once, and in no line.
TEST(Table, IsGroupedAndSaysZerosOnce) {
  DerivativeSet derivatives;
  derivatives[Variable::alpha] = {.CA = {0.01, 0.02}, .CY = {1e-6, 0.02}, .CN = {9, 0.02}, .Cl = {0.3, 0.02}};
  derivatives[Variable::beta] = {.CY = {-9, 0.02}, .CN = {0.02, 0.02}, .Cn = {30, 0.02}};
  derivatives[control_variable("rudder")] = {.CN = {1e-3, 0.02}, .Cn = {-4, 0.02}};
  const auto rows = rows_of(derivatives, "m");
  const TableHead head{example().reference};
  const auto table = derivative_table(rows, head), csv = derivative_csv(rows, head);
  EXPECT_TRUE(std::regex_search(
      table,
      std::regex("longitudinal\nCA_alpha .*\nCN_alpha .*\n  lateral\nCY_beta .*\nCn_beta .*\n  cross\n"
                 "Cl_alpha .*\n  controls\nCn_rudder .*\nZero within their ±: CY_alpha CN_beta CN_rudder\n")))
      << table;
  EXPECT_TRUE(contains(csv, "# Zero within their ±: CY_alpha CN_beta CN_rudder\n")) << csv;
  EXPECT_TRUE(contains(csv, ",yes,cross\nCN_beta,")) << csv;
  derivatives[Variable::alpha].CY.uncertainty = std::numeric_limits<Real>::infinity();
  EXPECT_TRUE(contains(derivative_table(rows_of(derivatives, "m"), head), "\nCY_alpha "));
  const auto half = rows_of({{Variable::alpha, {.CA = {1, 1}, .CN = {9, 1}}}}, "m");
  EXPECT_FALSE(contains(derivative_table(half, head), "longitudinal")) << "one group needs no name";
}

// What a run did not reach, and that no mesh was assessed, stand beside the numbers.
TEST(Table, SaysHowFarItsNumbersAreToBeTrusted) {
  const auto point = example();
  auto rows = rows_of(point.derivatives, "linear solve", Axes::body, {}, {Variable::alphadot});
  const TableHead head{point.reference, "not_converged: 2 of 3 decades", uncertainty_scope(rows)};
  EXPECT_EQ(head.uncertainty, "solver only; mesh not assessed");
  const auto table = derivative_table(rows, head), csv = derivative_csv(rows, head);
  EXPECT_TRUE(contains(table, "\nStatus: not_converged: 2 of 3 decades\n")) << table;
  EXPECT_TRUE(contains(table, "\nUncertainty: solver only; mesh not assessed\n"));
  EXPECT_TRUE(std::regex_search(table, std::regex("\nname +value +solver only +method\n")));
  EXPECT_TRUE(std::regex_search(table, std::regex("\nCm_alphadot .*linear solve; not converged\n")));
  EXPECT_TRUE(std::regex_search(table, std::regex("\nCm_alpha .*linear solve\n")));
  EXPECT_TRUE(contains(csv, "# Status: not_converged: 2 of 3 decades\n"));
  EXPECT_TRUE(std::regex_search(csv, std::regex("\nCm_alphadot,.*,no,longitudinal\n")));
  EXPECT_TRUE(std::regex_search(csv, std::regex("\nCm_alpha,.*,yes,longitudinal\n")));
  for (auto& row : rows) row.parts = {{"linear", 0.01}, {"mesh", 0.02}};
  EXPECT_EQ(uncertainty_scope(rows), "solver and mesh");
  rows.back().parts.pop_back();
  EXPECT_EQ(uncertainty_scope(rows), "solver only; mesh not assessed");
}

TEST(FlightPoint, ExchangeFormatsSayTheStatus) {
  auto point = example();
  EXPECT_FALSE(contains(avl_stability_text(point), "Status"));
  point.status = "not_converged: on a--b.msh: 2 of 3 decades";
  point.origin = "Mach 2, alpha 1 deg; mesh a--b.msh";
  EXPECT_TRUE(
      contains(avl_stability_text(point), " Configuration: example; Mach 2, alpha 1 deg; mesh a--b.msh\n"));
  EXPECT_TRUE(contains(jsbsim_aerodynamics(point), "Flow: Mach 2, alpha 1 deg; mesh a- -b.msh."));
  EXPECT_TRUE(contains(avl_stability_text(point), " Status: not_converged: on a--b.msh: 2 of 3 decades\n"));
  const auto xml = jsbsim_aerodynamics(point);
  EXPECT_TRUE(contains(xml, "Status: not_converged: on a- -b.msh: 2 of 3 decades.")) << xml;
}

/// Every "name = number" of a text, as AVL's readers look for them.
std::map<std::string, Real> assignments(const std::string& text) {
  std::map<std::string, Real> out;
  const std::regex pattern("([A-Za-z][A-Za-z'/0-9]*) *= *([-+0-9.e]+)");
  for (std::sregex_iterator i(text.begin(), text.end(), pattern), end; i != end; ++i)
    out[(*i)[1]] = std::stod((*i)[2]);
  return out;
}

// Expected: the turned derivatives, printed to six decimals; total forces with AVL's signs (X forward, Z
// down).
TEST(Avl, EntriesAreFoundByName) {
  const FlightPoint point = example();
  const auto text = avl_stability_text(point);
  const auto found = assignments(text);
  const Real alpha = 2 * radians_per_degree;
  const auto turned = to_stability_axes(point.derivatives, point.steady, alpha);
  EXPECT_NEAR(found.at("CLa"), turned.at(Variable::alpha).CN.value, 1e-6);
  EXPECT_NEAR(found.at("CDa"), turned.at(Variable::alpha).CA.value, 1e-6);
  EXPECT_NEAR(found.at("Cnb"), turned.at(Variable::beta).Cn.value, 1e-6);
  EXPECT_NEAR(found.at("Clp"), turned.at(Variable::p).Cl.value, 1e-6);
  EXPECT_NEAR(found.at("Cmq"), turned.at(Variable::q).Cm.value, 1e-6);
  EXPECT_NEAR(found.at("Cnr"), turned.at(Variable::r).Cn.value, 1e-6);
  EXPECT_NEAR(found.at("Cmad"), turned.at(Variable::alphadot).Cm.value, 1e-6);
  EXPECT_NEAR(found.at("CYbd"), turned.at(Variable::betadot).CY.value, 1e-6);
  EXPECT_NEAR(found.at("CZtot"), -0.3, 1e-6);
  EXPECT_NEAR(found.at("CXtot"), -0.4, 1e-6);
  EXPECT_NEAR(found.at("CLtot"), 0.3 * std::cos(alpha) - 0.4 * std::sin(alpha), 1e-5);
  EXPECT_NEAR(found.at("Cref"), 2, 1e-9);
  EXPECT_NEAR(found.at("Alpha"), 2, 1e-9);
  EXPECT_NEAR(found.at("Mach"), 2.5, 1e-9);
  EXPECT_NEAR(found.at("Xnp"), 5.5 - 2 * 10.5 / 10.3, 1e-6);  // from CN_alpha, as in the other files
}

TEST(Avl, UnknownColumnsAreNoNumbers) {
  FlightPoint point = example();
  std::erase_if(point.derivatives, [](const auto& column) { return column.first != Variable::alpha; });
  const std::string text = avl_stability_text(point);
  const auto found = assignments(text);
  EXPECT_TRUE(found.contains("CLa"));
  for (const char* name : {"CLb", "CLp", "CLq", "CLad"}) {
    EXPECT_FALSE(found.contains(name)) << name;
    EXPECT_TRUE(std::regex_search(text, std::regex(std::string(name) + " = +nan"))) << name;
  }
}

/// The number in columns [first, last) of a line, all counted from 0; NAN when there is none.
Real number_at(const std::string& text, std::size_t line, std::size_t first, std::size_t last) {
  std::istringstream lines(text);
  std::string found;
  for (std::size_t i = 0; i <= line; ++i) std::getline(lines, found);
  if (found.size() <= first) return NAN;
  std::istringstream columns(found.substr(first, last - first));
  Real value = NAN;
  std::string rest;
  return columns >> value && !(columns >> rest) ? value : NAN;
}

// Where programs that read AVL's files by line and column look: references in lines 8 and 9, alpha to Mach in
// 15 to 17, totals in 19 to 24, alpha and beta derivatives in 36 to 40, those of the rates in 44 to 48, the
// neutral point in 50.
TEST(Avl, NumbersStandOnAvlsLines) {
  FlightPoint full = example(), half = example();
  full.title = "a title\nof two lines";
  half.reference.half_model = true;
  for (const Variable variable : {Variable::beta, Variable::p, Variable::r, Variable::betadot})
    half.derivatives.erase(variable);
  for (const FlightPoint& point : {full, half}) {
    const std::string text = avl_stability_text(point);
    const auto by_key = assignments(text);
    EXPECT_EQ(number_at(text, 8, 10, 16), 3);
    EXPECT_EQ(number_at(text, 8, 31, 37), 2);
    EXPECT_EQ(number_at(text, 9, 10, 16), 5.5);
    EXPECT_EQ(number_at(text, 15, 10, 19), 2);
    EXPECT_EQ(number_at(text, 17, 10, 19), 2.5);
    EXPECT_EQ(number_at(text, 20, 31, 41), -0.5);
    EXPECT_NEAR(number_at(text, 23, 10, 19), by_key.at("CLtot"), 1e-12);
    EXPECT_NEAR(number_at(text, 24, 10, 19), by_key.at("CDtot"), 1e-12);
    const char* const coefficients[] = {"CL", "CY", "Cl", "Cm", "Cn"};
    for (std::size_t i = 0; i < 5; ++i)
      for (const auto& [suffix, line, column] :
           {std::tuple{"a", 36, 24}, {"b", 36, 44}, {"p", 44, 24}, {"q", 44, 44}, {"r", 44, 64}}) {
        const std::string name = std::string(coefficients[i]) + suffix;
        const Real value = number_at(text, static_cast<std::size_t>(line) + i,
                                     static_cast<std::size_t>(column), static_cast<std::size_t>(column) + 10);
        if (by_key.contains(name))
          EXPECT_EQ(value, by_key.at(name)) << name;
        else
          EXPECT_TRUE(std::isnan(value) && point.reference.half_model) << name;
      }
    EXPECT_NEAR(number_at(text, 50, 22, 33), 5.5 - 2 * 10.5 / 10.3, 1e-6);
  }
}

// Six columns hold a number to be read by column; what they cannot hold must not be read as another one.
TEST(Avl, ReferencesAreReadWholeOrNotAtAll) {
  FlightPoint point = example();
  for (const Real area :
       {3.0, 0.12566, 0.7853981634, 28.274333882, 12345.678, 0.00125, 4.2e-5, 1234567.0, 9.9e7}) {
    point.reference.area = area;
    const std::string text = avl_stability_text(point);
    EXPECT_NEAR(assignments(text).at("Sref"), area, 5e-5 * area);
    const Real by_column = number_at(text, 8, 10, 16);
    if (!std::isnan(by_column)) {
      EXPECT_NEAR(by_column, area, 0.05 * area) << area;
    }
    if (area >= 0.1 && area < 99999) {
      EXPECT_NEAR(by_column, area, 1e-3 * area);
    }
    EXPECT_EQ(number_at(text, 8, 31, 37), 2);
  }
}

/// Value of a JSBSim function of the text at the given properties.
Real evaluate(const std::string& xml, const std::string& name,
              const std::map<std::string, Real>& properties) {
  const auto begin = xml.find("<function name=\"aero/coefficient/" + name + "\">");
  if (begin == std::string::npos) return NAN;
  std::string body = xml.substr(begin, xml.find("</function>", begin) - begin);
  Real product = 1;
  const std::regex difference("<difference><property>([^<]*)</property><value>([^<]*)</value></difference>");
  for (std::smatch m; std::regex_search(body, m, difference); body = m.prefix().str() + m.suffix().str())
    product *= properties.at(m[1]) - std::stod(m[2]);
  const std::regex factor("<(property|value)>([^<]*)<");
  for (std::sregex_iterator i(body.begin(), body.end(), factor), end; i != end; ++i)
    product *= (*i)[1] == "property" ? properties.at((*i)[2]) : std::stod((*i)[2]);
  return product;
}

// The model is evaluated as JSBSim does and compared with qbar S (c) times the linear expansion, by hand.
TEST(Jsbsim, FunctionsGiveTheLinearModel) {
  const std::string xml = jsbsim_aerodynamics(example());
  const Real alpha0 = 2 * radians_per_degree;
  const std::map<std::string, Real> properties{{"aero/qbar-area", 7},
                                               {"metrics/cbarw-ft", 2},
                                               {"aero/ci2vel", 0.01},
                                               {"aero/alpha-rad", alpha0 + 0.1},
                                               {"aero/beta-rad", 0.2},
                                               {"velocities/p-aero-rad_sec", 3},
                                               {"velocities/q-aero-rad_sec", 4},
                                               {"velocities/r-aero-rad_sec", 5},
                                               {"aero/alphadot-rad_sec", 6},
                                               {"aero/betadot-rad_sec", 8}};
  EXPECT_NEAR(evaluate(xml, "CN_0", properties), 7 * 0.3, 1e-9);
  EXPECT_NEAR(evaluate(xml, "Cm_0", properties), 7 * 2 * -0.5, 1e-9);
  EXPECT_NEAR(evaluate(xml, "CN_alpha", properties), 7 * 10.3 * 0.1, 1e-7);
  EXPECT_NEAR(evaluate(xml, "Cn_beta", properties), 7 * 2 * 20.6 * 0.2, 1e-7);
  EXPECT_NEAR(evaluate(xml, "Cl_p", properties), 7 * 2 * 30.4 * 3 * 0.01, 1e-7);
  EXPECT_NEAR(evaluate(xml, "Cm_q", properties), 7 * 2 * 40.5 * 4 * 0.01, 1e-7);
  EXPECT_NEAR(evaluate(xml, "CY_r", properties), 7 * 50.2 * 5 * 0.01, 1e-7);
  EXPECT_NEAR(evaluate(xml, "Cm_alphadot", properties), 7 * 2 * 60.5 * 6 * 0.01, 1e-7);
  EXPECT_NEAR(evaluate(xml, "CY_betadot", properties), 7 * 70.2 * 8 * 0.01, 1e-7);
  EXPECT_FALSE(contains(xml, "q_plus_alphadot")) << "would count the same damping twice";
}

// Cm_alpha 10.5 with CN_alpha 10.3 about 5.5, length 2: 5.5 - 2 * 10.5 / 10.3.
TEST(Jsbsim, SaysWhereTheNeutralPointIs) {
  EXPECT_TRUE(contains(jsbsim_aerodynamics(example()), "Neutral point at x = 3.46117."));
}

// Every coefficient sits on JSBSim's axis of the same sense, and the elements close in order.
TEST(Jsbsim, AxesAndNesting) {
  const std::string xml = jsbsim_aerodynamics(example());
  const std::map<std::string, std::string> axis_of{{"CA", "AXIAL"}, {"CY", "SIDE"},  {"CN", "NORMAL"},
                                                   {"Cl", "ROLL"},  {"Cm", "PITCH"}, {"Cn", "YAW"}};
  for (const auto& [coefficient, axis] : axis_of) {
    const auto begin = xml.find("<axis name=\"" + axis + "\">"), end = xml.find("</axis>", begin);
    const auto function = xml.find("aero/coefficient/" + coefficient + "_alphadot");
    EXPECT_TRUE(begin < function && function < end) << coefficient;
  }
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-z_]+)[^>]*>");
  for (std::sregex_iterator i(xml.begin(), xml.end(), tag), end; i != end; ++i) {
    if ((*i)[1].length() == 0) {
      open.push_back((*i)[2]);
    } else {
      ASSERT_FALSE(open.empty());
      EXPECT_EQ(open.back(), (*i)[2]);
      open.pop_back();
    }
  }
  EXPECT_TRUE(open.empty());
}

}  // namespace
}  // namespace alphadot
