#pragma once
/// @file
/// A figure of the report as a gnuplot script with its data, so that an author can restyle it.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace a351::corrector {

/// Runs in the folder that holds its data: `gnuplot NAME.gp` writes NAME.svg, and
/// `gnuplot -e "format='pdf'" NAME.gp` NAME.pdf (or png).
struct Figure {
    std::string name;       ///< Stem of its files: small letters, digits, '-'.
    std::string caption;    ///< Plain text.
    std::string script;     ///< NAME.gp
    std::string data;       ///< NAME.dat; empty when it plots the data of others.
    bool is_small = false;  ///< Two fit beside each other on a page.
};

/// Okabe and Ito's colours, told apart by the colour-blind too (https://jfly.uni-koeln.de/color/).
inline const std::string kBlue = "'#0072B2'";
inline const std::string kVermilion = "'#D55E00'";
inline const std::string kGrey = "'#888888'";

/// Of a curve or scatter over the whole of a record, so that a figure of weeks stays small.
inline constexpr std::size_t kMostPoints = 3000;

/// Resets what an earlier script set, chooses the terminal by `format` (default svg), names the
/// output and the common style.
/// @param width_px, height_px  of the SVG at 96 per inch; PDF and PNG have its proportions.
[[nodiscard]] std::string script_head(const std::string& name, int width_px, int height_px);

/// Closes the output.
[[nodiscard]] std::string script_tail();

/// The greatest of 1, 2, 5, 10 ... (and 0.5, 0.2 ...) not above a limit > 0.
[[nodiscard]] double round_step(double limit);

/// The number, or NaN as gnuplot knows it, followed by a blank.
[[nodiscard]] std::string datum(double value, int decimals);

/// Blocks of lines, as gnuplot's `index` counts them; an empty block is left out, and then none of
/// its plots may be drawn.
class DataBlocks {
public:
    /// @param title  a comment on what the columns are.
    /// @return number of the block for `index`; std::nullopt when `lines` is empty.
    std::optional<int> add(const std::string& title, const std::string& lines);

    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::string text_;
    int count_ = 0;
};

/// What plots a block of NAME.dat: `'NAME.dat' index BLOCK REST`.
/// @param block  as DataBlocks::add() gave it; not std::nullopt.
[[nodiscard]] std::string block_clause(const std::string& name, std::optional<int> block,
                                       const std::string& rest);

/// "plot A, \<newline> B, ..." of the clauses; at least one.
[[nodiscard]] std::string plot_command(const std::vector<std::string>& clauses);

}  // namespace a351::corrector
