// Small systems of equations, made of factors and solutions in whole numbers, so that nothing is rounded.

#include <gtest/gtest.h>

#include "core/cholesky.hpp"

namespace roadstereo {
namespace {

constexpr double none = 1e-12;
// The factor is (2 0 0; 1 3 0; −4 5 1), the solution (7, −2, 3). What is above the diagonal is not looked at.
constexpr Matrix<3> definite{{{4, -99, -99}, {2, 10, -99}, {-8, 11, 42}}};
constexpr Vector<3> right{0, 27, 48};
constexpr Vector<3> expected{7, -2, 3};

TEST(Cholesky, RecoversKnownSolution) {
  const auto solution = solve_positive_definite(definite, right, none);
  ASSERT_TRUE(solution);
  EXPECT_EQ(*solution, expected);
}

TEST(Cholesky, RejectsIndefiniteMatrix) {
  EXPECT_FALSE(solve_positive_definite(Matrix<2>{{{4, 0}, {6, 9}}}, {1, 1}, none)) << "singular";
  EXPECT_FALSE(solve_positive_definite(Matrix<2>{{{4, 0}, {6, 8}}}, {1, 1}, none)) << "indefinite";
  EXPECT_FALSE(solve_positive_definite(Matrix<2>{}, {0, 0}, none));
}

TEST(Cholesky, RejectsPivotBelowTolerance) {
  const Matrix<2> close{{{4, 0}, {6, 9.09}}};  // 1 % of the second diagonal element is left
  EXPECT_TRUE(solve_positive_definite(close, {1, 1}, 0.009));
  EXPECT_FALSE(solve_positive_definite(close, {1, 1}, 0.011));
}

/// The second unknown is the first once more: it is left out, and the others are those of the system without it.
TEST(Cholesky, SkipsDependentRows) {
  Matrix<3> a{{{4, 0, 0}, {8, 16, 0}, {2, 4, 10}}};
  EXPECT_EQ(factor_in_place(a, none), 1U);
  EXPECT_EQ(solve_factored(a, {24, 48, 66}), (Vector<3>{3, 0, 6}));
}

}  // namespace
}  // namespace roadstereo
