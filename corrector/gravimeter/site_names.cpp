#include "corrector/gravimeter/site_names.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "protocol/core/input_error.hpp"
#include "protocol/text/doubtful_site.hpp"

namespace a351::corrector::gravimeter {

std::string table_name(std::string_view name) {
    std::string text(name);
    std::ranges::replace(text, ',', ';');
    std::ranges::replace(text, '"', '\'');
    if (!text.empty() && std::string_view("=+-@").find(text.front()) != std::string_view::npos)
        text.insert(0, "_");
    return text;
}

std::vector<text::Message> make_table_names(std::vector<GravimeterFile>& files) {
    std::map<std::string, std::string> name_in_file;  // by the name in the tables
    std::map<std::string, std::size_t> count;
    std::vector<text::Message> remarks;
    for (GravimeterFile& file : files)
        for (Reading& reading : file.readings) {
            const std::string name = table_name(reading.site);
            const auto [known, is_new] = name_in_file.try_emplace(name, reading.site);
            if (known->second != reading.site)
                throw InputError(fmt::format(
                    "{}:{}: station = {}: would be {} in the tables, as {} is; allowed: one of "
                    "the two under another name",
                    file.path.string(), reading.line, reading.site, name, known->second));
            if (is_new && name != reading.site)
                remarks.push_back(
                    text::message("the station {} is {} in the tables, because they "
                                  "cannot have its name",
                                  reading.site, name));
            reading.site = name;
            ++count[name];
        }
    for (auto one = count.begin(); one != count.end(); ++one)
        for (auto other = std::next(one); other != count.end(); ++other)
            if (text::differ_in_writing(one->first, other->first))
                remarks.push_back(text::message(
                    "the names {} and {} differ only in capitals, blanks or zeros. They are two "
                    "stations here, with {} and {} readings: if they are one, use one name in "
                    "the files",
                    one->first, other->first, one->second, other->second));
    return remarks;
}

}  // namespace a351::corrector::gravimeter
