#pragma once
/// @file
/// The fields of the status, declared once.
///
/// GET /api/status, GET /metrics, the rows that the page and `a351ctl status` show, and the list in
/// a351d-http(7) are all written from this declaration.  A new field is one entry:
///
///     {.path = "/disk/free_bytes",
///      .value = of(&Status::disk_free_bytes),
///      .meaning = "Free disk space for the recorded data.",
///      .unit = "bytes",
///      .shown = {text::marked("disk"), text::marked("free")},
///      .metric = {.name = "a351_disk_free_bytes"}},

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/live/live_record.hpp"
#include "daemon/survey/so_far.hpp"
#include "daemon/status/status.hpp"
#include "daemon/survey/field_status.hpp"
#include "daemon/survey/occupations.hpp"

namespace a351::daemon::page {

/// Version of the interface, published as `api`; increased when a field changes its meaning.
inline constexpr int kApiVersion = 1;

/// The verdict as published.
struct Judgement {
    verdict::Verdict verdict;            ///< "no data" if the last sample is old.
    std::vector<text::Message> reasons;  ///< Reasons why it is not stable.
};

/// Returns the verdict of a status.
/// @param stale_after  age of the last sample from which on there are no data.
[[nodiscard]] Judgement judged(const status::Status& status, Nanoseconds stale_after);

/// Sources of the status, at one instant.
struct Moment {
    const status::Status& status;
    const survey::Occupations& occupations;
    const survey::FieldStatus& field;
    const live::Record& live;
    const Judgement& judgement;
    const survey::Signal& signal;
    const survey::SoFar& so_far;
};

/// How people see a field.  A default-constructed one hides it from them.
struct Shown {
    enum class As {
        value,   ///< Number, text, or the label alone if it is true.
        word,    ///< Text of the catalogue, such as the name of a state.
        denial,  ///< The label alone if it is false.
        index,   ///< Index of a sample, and its distance from the last sample received.
        counts   ///< Counts of trouble that are not zero, by their names.
    };
    static constexpr int kAllDecimals = -1;

    std::string_view row = {};    ///< Heading of the row, text of the catalogue.
    std::string_view label = {};  ///< Words before the value, text of the catalogue; may be empty.
    int decimals = kAllDecimals;  ///< Decimals of a number that is not whole.
    As as = As::value;
};

/// The metric of a field in Prometheus' format.  A default-constructed one has no name: no metric.
struct Metric {
    enum class As {
        number,    ///< The number; no sample if there is none.
        items,     ///< A sample for each item of an object, with the item's name as label.
        states,    ///< A sample for each of `states`: 1 for the present one, 0 for the others.
        text,      ///< 1, with the text as label.
        existence  ///< 1 if the field is not null, else 0.
    };
    std::string name = {};
    std::string_view key = {};    ///< Name of the label; empty: no label.
    std::string_view label = {};  ///< Its value, if it is a constant.
    As as = As::number;
    std::string_view help = {};                 ///< If several fields are one metric: its meaning.
    double scale = 1.0;                         ///< From the unit of the field to the base unit.
    std::vector<std::string_view> states = {};  ///< The possible texts.
};

/// One field.
struct Field {
    std::string path;  ///< JSON pointer.
    /// Function that returns the value; a discarded one: the field is left out.
    std::function<nlohmann::json(const Moment&)> value;
    std::string_view meaning;  ///< For the manual page and the metrics.
    std::string_view unit = {};
    Shown shown = {};
    Metric metric = {};
};
using Fields = std::vector<Field>;

/// Returns all fields, in the order of the rows.
[[nodiscard]] const Fields& status_fields();

/// Return its parts: signal, stay, tilt and details; sensor and ovens; timing, counters and disk.
[[nodiscard]] Fields operator_fields();
[[nodiscard]] Fields sensor_fields();
[[nodiscard]] Fields recorder_fields();

}  // namespace a351::daemon::page
