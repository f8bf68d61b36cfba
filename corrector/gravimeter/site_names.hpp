#pragma once
/// @file
/// Names of stations, from those in the files of instruments to those that the tables can have.
///
///     for (const text::Message& remark : make_table_names(files)) warn(remark);

#include <string>
#include <string_view>
#include <vector>

#include "corrector/gravimeter/gravimeter_file.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::gravimeter {

/// Returns the name that the tables have for a station: `;` for a comma, `'` for a quotation mark,
/// and `_` before one of = + - @ at its beginning, which a spreadsheet takes as a formula.
[[nodiscard]] std::string table_name(std::string_view name);

/// Gives all readings the names of the tables.
/// @return one sentence for each name that was changed, and for each two names that differ only in
///         their writing (text::differ_in_writing()): these remain two stations.
/// @throws InputError  two names of the files would be one in the tables.
[[nodiscard]] std::vector<text::Message> make_table_names(std::vector<GravimeterFile>& files);

}  // namespace a351::corrector::gravimeter
