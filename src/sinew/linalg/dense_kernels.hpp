/// @file
/// The dense arithmetic of the block factorisation: products of panels, and the factorisation and
/// substitution of one panel. Column-major, sizes multiples of 3. Every entry is computed by the
/// same operations in the same order, however rows are cut into pieces.
#pragma once

namespace sinew::linalg {

/// Numbers behind the last row that kernels may touch.
inline constexpr int kOverrun = 8;

/// Two operands A (rows, depth) and B (columns, depth) of a product A B^T.
struct Product {
  const double* a;
  long leading_a;
  const double* b;
  long leading_b;
  int depth;
  int columns;
};

/// What a product does to the numbers that are there.
enum class Store { assign, add, subtract };
/// All of a product, or of a square part the lower triangle: entries (i, j) with j <= i, and
/// some above.
enum class Part { lower, whole };

/// c(i - row_begin, j) = (A B^T)(i, j) for row_begin <= i < row_end and j < columns, or += or -=.
/// Reads up to 7 rows of A past the end, and changes up to 7 rows of c by what A holds there.
void multiply(const Product& product, int row_begin, int row_end, double* c, long leading,
              Store store, Part part = Part::whole);

/// The diagonal block of a panel and what its factorisation L S L^T, S = diag(+-1), leaves.
struct DiagonalBlock {
  double* panel;          ///< column-major
  long leading;           ///< doubles from column to column
  int columns;            ///< a multiple of 3
  double* inverse;        ///< (columns,) 1 / L_jj; in: magnitude that pivot j is measured against
  double* sign;           ///< (columns,) S
  int negatives = 0;      ///< out: negative pivots
  bool singular = false;  ///< out: a pivot vanished and was replaced
  double* scratch;        ///< 6 * columns doubles
};

/// Factorises rows 0 .. columns-1 and carries it through rows columns .. row_end-1 in one pass.
/// Changes up to 7 rows past row_end; they must hold zeros, or rows that are not in use.
void factorise_panel(DiagonalBlock& block, int row_end);

/// Carries a finished factorisation through rows row_begin .. row_end-1 (row_end - row_begin a
/// multiple of 8, or zeros behind).
void solve_panel_rows(const DiagonalBlock& block, int row_begin, int row_end);

/// The same for `count` rows that stand by themselves, column-major; changes up to 7 rows more.
void solve_rows_apart(const DiagonalBlock& block, double* rows, long leading, int count);

/// Backward substitution with one panel: v holds the values of the rows below, zeros at the
/// padding, and y in its first `columns` entries, which become x: L^T x = y - L_below^T v_below.
void backward_panel(const double* panel, long leading, int columns, int height,
                    const double* inverse, double* v);

/// Forward substitution: v holds r in its first `columns` entries, zeros below. They become u with
/// L u = r, and the rows below -(L_below u).
void forward_panel(const double* panel, long leading, int columns, int height,
                   const double* inverse, double* v);

}  // namespace sinew::linalg
