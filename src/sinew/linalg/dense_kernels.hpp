/// @file
/// Dense kernels of the block factorisation: products of panels, and factorisation and substitution
/// of one panel. Arrays are column-major, sizes multiples of 3. Every entry is computed by the same
/// operations in the same order, however the rows are divided.
#pragma once

namespace sinew::linalg {

/// Number of doubles after the last row that kernels may access.
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

/// How a product is combined with the values in the target.
enum class Store { assign, add, subtract };
/// The part of a product to compute: all of it, or the lower triangle j <= i, with some entries
/// above.
enum class Part { lower, whole };

/// Computes c(i - row_begin, j) = (A B^T)(i, j) for row_begin <= i < row_end and j < columns, or +=
/// or -=. Reads up to 7 rows of A past the end, and changes up to 7 rows of c past the end with
/// them.
void multiply(const Product& product, int row_begin, int row_end, double* c, long leading,
              Store store, Part part = Part::whole);

/// The diagonal block of a panel and the results of its factorisation L S L^T, S = diag(+-1).
struct DiagonalBlock {
  double* panel;          ///< column-major
  long leading;           ///< doubles from column to column
  int columns;            ///< a multiple of 3
  double* inverse;        ///< (columns,) out: 1 / L_jj; in: magnitude to which pivot j is compared
  double* sign;           ///< (columns,) S
  int negatives = 0;      ///< out: number of negative pivots
  bool singular = false;  ///< out: whether a pivot vanished and was replaced
  double* scratch;        ///< 6 * columns doubles
};

/// Factorises rows 0 .. columns-1 and solves for rows columns .. row_end-1 in one pass. Changes up
/// to 7 rows past row_end, which must be zero or unused.
void factorise_panel(DiagonalBlock& block, int row_end);

/// Solves for rows row_begin .. row_end-1 with a factorised diagonal block. row_end - row_begin
/// must be a multiple of 8, or followed by rows of zeros.
void solve_panel_rows(const DiagonalBlock& block, int row_begin, int row_end);

/// The same for `count` rows in a separate array, column-major; changes up to 7 more rows.
void solve_rows_apart(const DiagonalBlock& block, double* rows, long leading, int count);

/// Backward substitution with one panel, L^T x = y - L_below^T v_below. v contains y in its first
/// `columns` entries, which become x, then zeros in the padding, and v_below.
void backward_panel(const double* panel, long leading, int columns, int height,
                    const double* inverse, double* v);

/// Forward substitution with one panel. v contains r in its first `columns` entries, and zeros
/// below. The former become u with L u = r, the latter -(L_below u).
void forward_panel(const double* panel, long leading, int columns, int height,
                   const double* inverse, double* v);

}  // namespace sinew::linalg
