#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/reading/survey_row.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::reading {

/// Kind of a mistake or a fault that was found in a day.
///
/// - moved_box: the box was moved while a stay ran.
/// - other_name: the reading is that of other_site.
/// - reference: the reference is off by size_mgal, positive if it is too high.
/// - step: from `time` on all readings are off by size_mgal, positive if they are too high.
/// - bad_reading: the reading is off by size_mgal, positive if it is too high; or it has no size.
/// - misfit: the model does not fit.
/// - unusable_day: the day is not usable as it is.
/// - scale: a coefficient is far from its prior, and is held there.
/// - start_up_test: the sensor failed its start-up test, or the result is not known.
/// - turned: the set-up is in another face than entered or planned.
///
/// From here on they are remarks, which are never headlines:
///
/// - not_visited: benchmarks of the list have no reading.
/// - no_stop: the stay was not stopped.
/// - early_start: the box was still moved when the stay was started.
/// - missed_set_up: the box was lifted and set down during the stay, and no set-up was entered.
/// - not_lifted: the set-up has the placement of the one before it.
/// - short_stay: the set-up is much shorter than the others of the day.
/// - base_not_revisited: the base has one stay only.
/// - doubtful_site: the list of sites has one that does not fit the others.
/// - clock: times are uncertain, the host's clock was set back, or most set-ups have no samples.
/// - other_unit: other sensors recorded in the time of the survey too.
enum class FindingKind {
    moved_box,
    other_name,
    reference,
    step,
    bad_reading,
    misfit,
    unusable_day,
    scale,
    start_up_test,
    turned,
    not_visited,
    no_stop,
    early_start,
    missed_set_up,
    not_lifted,
    short_stay,
    base_not_revisited,
    doubtful_site,
    clock,
    other_unit,
};

/// Returns the name of a kind, as above.
[[nodiscard]] std::string_view to_text(FindingKind kind);

/// A mistake or a fault that was found in a day.
struct Finding {
    FindingKind kind = FindingKind::moved_box;
    std::string code = {};               ///< Code of the sentence in `text`.
    std::string site = {};               ///< Site; empty if it concerns the whole day.
    std::optional<int> occupation = {};  ///< Number of the stay at this site.
    std::string key = {};                ///< Key of the stay in the event log; may be empty.
    std::optional<UtcTime> time = {};    ///< When it happened.
    std::optional<double> size_mgal = {}, u_mgal = {};
    std::string other_site = {};
    text::Message text = {};     ///< One sentence.
    std::string amendment = {};  ///< Amendment that carries out the proposal, TOML; may be empty.
    bool is_headline = false;    ///< So certain that it belongs to the first line.
};

/// Returns true for the remarks above.
[[nodiscard]] bool is_remark(const Finding& finding);

/// Returns true for other_name, reference, step and bad_reading.
[[nodiscard]] bool is_mistake(const Finding& finding);

/// Returns a duration as "12.3 min".
[[nodiscard]] std::string in_minutes(Nanoseconds time);

/// Sets the stay of a finding.
void set_stay(Finding& finding, const SetUp& set_up, UtcTime time);
/// The same, from the first instant of a row on.
void set_stay(Finding& finding, const SurveyRow& row);

/// Returns the first lines of an amendment: [[KIND]], site, occupation and, if the stay has several,
/// set_up.
[[nodiscard]] std::string amendment_head(std::string_view kind, const ListedSetUp& listed);

/// Returns the amendment that renames the stay of a set-up; empty if it cannot be amended.
[[nodiscard]] std::string rename_amendment(const SetUp& set_up, const std::string& to,
                                           const std::string& reason);

/// Returns an array with one object per finding, for result.json.  What does not apply is null.
[[nodiscard]] nlohmann::ordered_json findings_json(const std::vector<Finding>& findings);

}  // namespace a351::corrector::reading
