#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/types.hpp"
#include "sinew/linalg/dense_kernels.hpp"

namespace sinew::linalg {
namespace {

/// Rows in a column-major panel with padding, which kernels may overwrite.
struct PanelRows {
  PanelRows(int rows, int columns, long leading, double rate)
      : height(rows),
        width(columns),
        stride(leading),
        values(VectorX::Zero(leading * columns + 64)) {
    for (int j = 0; j < columns; ++j) {
      for (int i = 0; i < rows; ++i) at(i, j) = std::sin(rate * (i + 1) + 0.37 * j * j);
    }
  }
  double& at(int i, int j) { return values[i + j * stride]; }
  MatrixX dense() const {
    return Eigen::Map<const MatrixX, 0, Eigen::OuterStride<>>(values.data(), height, width,
                                                              Eigen::OuterStride<>(stride));
  }
  int height, width;
  long stride;
  VectorX values;
};

Product product_of(PanelRows& a, PanelRows& b) {
  return {a.values.data(), a.stride, b.values.data(), b.stride, a.width, b.height};
}

// Kernels copy columns that are far apart in memory before they multiply them.
TEST(PanelKernels, ProductsAgreeWithEigensInEveryMode) {
  for (const int rows : {5, 131}) {
    for (const int columns : {51, 201}) {
      for (const int depth : {9, 60, 160}) {
        PanelRows a(rows, depth, 408, 0.7), b(columns, depth, 408, 1.3);
        const MatrixX expected = a.dense() * b.dense().transpose();
        const MatrixX before = PanelRows(rows, columns, 152, 0.2).dense();
        const double tolerance = 1e-14 * depth;
        for (const auto& [store, sum] :
             {std::pair(Store::assign, expected), std::pair(Store::add, MatrixX(before + expected)),
              std::pair(Store::subtract, MatrixX(before - expected))}) {
          PanelRows whole(rows, columns, 152, 0.2), lower(rows, columns, 152, 0.2);
          multiply(product_of(a, b), 0, rows, whole.values.data(), whole.stride, store);
          EXPECT_LT((whole.dense() - sum).cwiseAbs().maxCoeff(), tolerance);
          multiply(product_of(a, b), 0, rows, lower.values.data(), lower.stride, store,
                   Part::lower);
          for (int j = 0; j < columns; ++j) {
            for (int i = j; i < rows; ++i) ASSERT_EQ(lower.at(i, j), whole.at(i, j));
          }
        }
      }
    }
  }
}

TEST(PanelKernels, ProductsHaveTheSameBitsHoweverTheyAreCutAndStored) {
  constexpr int kRows = 131, kColumns = 150, kDepth = 140;
  PanelRows a(kRows, kDepth, 408, 0.7), b(kColumns, kDepth, 408, 1.3);
  PanelRows near_a(kRows, kDepth, 152, 0.7), near_b(kColumns, kDepth, 152, 1.3);
  PanelRows whole(kRows, kColumns, 152, 0.0);
  multiply(product_of(a, b), 0, kRows, whole.values.data(), whole.stride, Store::assign);
  PanelRows near(kRows, kColumns, 152, 0.0);
  multiply(product_of(near_a, near_b), 0, kRows, near.values.data(), near.stride, Store::assign);
  EXPECT_EQ(near.dense(), whole.dense());
  for (const int cut : {5, 40, 77}) {
    PanelRows top(kRows, kColumns, 152, 0.0), bottom(kRows, kColumns, 152, 0.0);
    multiply(product_of(a, b), 0, cut, top.values.data(), top.stride, Store::assign);
    multiply(product_of(a, b), cut, kRows, bottom.values.data(), bottom.stride, Store::assign);
    EXPECT_EQ(top.dense().topRows(cut), whole.dense().topRows(cut));
    EXPECT_EQ(bottom.dense().topRows(kRows - cut), whole.dense().bottomRows(kRows - cut));
  }
}

/// Factorises [A; B], A definite or indefinite: L S L^T is A, and (B L^-T S) S L^T is B.
void expect_factorised(int columns, int below, double shift) {
  const int height = columns + below;
  const long leading = (height + 15) / 8 * 8;
  PanelRows panel(height, columns, leading, 0.9);
  const MatrixX wave = panel.dense().topRows(columns);
  MatrixX a = 0.5 * (wave + wave.transpose());
  a.diagonal().array() += shift;
  a.diagonal().tail(columns / 3).array() *= shift > 0 ? 1.0 : -1.0;
  const MatrixX b = panel.dense().bottomRows(below);
  VectorX inverse = a.diagonal().cwiseAbs(), sign(columns), scratch(6 * columns);
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < columns; ++i) panel.at(i, j) = a(i, j);
  }
  DiagonalBlock block{.panel = panel.values.data(),
                      .leading = leading,
                      .columns = columns,
                      .inverse = inverse.data(),
                      .sign = sign.data(),
                      .scratch = scratch.data()};
  PanelRows apart(below, columns, below + 8, 0.0);
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < below; ++i) apart.at(i, j) = b(i, j);
  }
  factorise_panel(block, height);
  ASSERT_FALSE(block.singular);
  EXPECT_EQ(block.negatives, (sign.array() < 0).count());
  EXPECT_EQ(block.negatives > 0, shift < 0);
  const MatrixX l = panel.dense().topRows(columns).triangularView<Eigen::Lower>();
  const MatrixX right = sign.asDiagonal() * l.transpose();
  EXPECT_LT((l * right - a).norm(), 1e-12 * a.norm());
  EXPECT_LT((panel.dense().bottomRows(below) * right - b).norm(), 1e-12 * b.norm() + 1e-300);
  solve_rows_apart(block, apart.values.data(), apart.stride, below);
  EXPECT_LT((apart.dense() * right - b).norm(), 1e-12 * b.norm() + 1e-300);
}

TEST(PanelKernels, PanelsOfAnyHeightAreFactorised) {
  for (const int columns : {9, 51, 144}) {
    for (const int below : {0, 60, 150}) {
      SCOPED_TRACE(::testing::Message() << columns << " columns, " << below << " below");
      expect_factorised(columns, below, 3.0 * columns);
      expect_factorised(columns, below, -3.0 * columns);
    }
  }
}

}  // namespace
}  // namespace sinew::linalg
