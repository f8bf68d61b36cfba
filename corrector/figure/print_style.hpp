#pragma once
/// @file
/// Sizes of the figures in print, in mm and points: the only place that knows them.
/// gnuplot_script.cpp turns them into commands of gnuplot, layout.cpp into places.
///
/// Authors change a size here, or in the first lines of a figure's script.

#include <optional>
#include <string_view>

namespace a351::corrector::figure {

/// Widths of one column and of a page, mm (Elsevier asks for 90 and 190, AGU for 95 and 190, SSJ for
/// 84 and 174; these fit all).
inline constexpr double kColumn_mm = 84.0, kPage_mm = 170.0;

/// Width that is asked for.  Without it a small figure is a column wide, and any other a page.
struct Print {
    std::optional<double> width_mm = {};

    [[nodiscard]] double wide_mm() const { return width_mm.value_or(kPage_mm); }
    [[nodiscard]] double small_mm() const { return width_mm.value_or(kColumn_mm); }
    [[nodiscard]] bool is_narrow() const { return wide_mm() <= kColumn_mm; }
};

/// Sizes of letters, points: headings, axes and keys; texts within a panel and names above it.
/// Journals ask for 6 to 8.
inline constexpr double kLetters_pt = 7.5, kSmallLetters_pt = 7.0;

/// Widths of lines, points: journals ask for 0.5 to 1.
inline constexpr double kThinLine_pt = 0.5, kLine_pt = 0.75, kStrongLine_pt = 1.0;

/// Height of a line of text, mm: 1.3 times that of its letters.
inline constexpr double kTextLine_mm = 3.5;

/// Heights of the panel, mm: of a small figure; of a figure that is a page wide; of one of several
/// panels, one above the other.
inline constexpr double kSmallPanel_mm = 55.0, kWidePanel_mm = 60.0, kStackedPanel_mm = 36.0;

/// Distances in mm: from the left border of the figure to the panel, for numbers of seven digits
/// at most; from the panel to the right border, for half a number; the same with numbers at the
/// right axis; the same with a scale of colours and numbers of six digits.
inline constexpr double kLeft_mm = 12.5, kRight_mm = 5.5, kRightAxis_mm = 12.5,
                        kColourScale_mm = 18.0;

/// Resolution of PNG, dots per inch.
inline constexpr double kPngDotsPerInch = 300.0;

inline constexpr double kMmPerInch = 25.4, kPointsPerInch = 72.0;

/// Returns the width of a text, mm, estimated by kinds of letters as they are in DejaVu Sans, the
/// widest of usual fonts.
[[nodiscard]] double text_width_mm(std::string_view text, double letters_pt = kLetters_pt);

}  // namespace a351::corrector::figure
