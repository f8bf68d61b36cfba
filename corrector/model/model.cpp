#include "corrector/model/model.hpp"

#include <algorithm>

#include "corrector/model/whole_day_model.hpp"

namespace a351::corrector::model {

const std::vector<Model>& models() {
    static const std::vector<Model> all = [] {
        std::vector<Model> list{paper_model(), whole_day_model()};
        for (Model& model : linear_models()) list.push_back(std::move(model));
        list.push_back(network_model());
        return list;
    }();
    return all;
}

const Model* find_model(std::string_view name) {
    const auto found = std::ranges::find(models(), name, &Model::name);
    return found == models().end() ? nullptr : &*found;
}

std::vector<std::string> model_names() {
    std::vector<std::string> names{std::string(kAutomatic)};
    for (const Model& model : models()) names.emplace_back(model.name);
    return names;
}

std::vector<CorrectedRow> uncorrected(const SurveyProblem& problem, const RowChoice& choice) {
    std::vector<CorrectedRow> rows;
    for (std::size_t i = 0; i < problem.rows.size(); ++i) {
        CorrectedRow& out = rows.emplace_back();
        out.row = problem.rows[i];
        out.is_used = choice.in_use[i];
        if (out.row.reference)
            out.difference = out.row.acceleration - *out.row.reference - out.row.tide;
    }
    return rows;
}

std::vector<std::string> station_names(const std::vector<reading::SurveyRow>& rows,
                                       const std::vector<bool>& among) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if ((among.empty() || among[i]) && std::ranges::find(names, rows[i].site) == names.end())
            names.push_back(rows[i].site);
    return names;
}

RowChoice choose_rows(const std::vector<reading::SurveyRow>& rows,
                      const std::vector<std::string>& datum, bool use_flags) {
    RowChoice choice;
    for (const reading::SurveyRow& row : rows) {
        choice.accepted.push_back(!row.is_excluded && !(use_flags && row.is_flagged));
        choice.in_use.push_back(choice.accepted.back() && row.is_datum(datum));
    }
    return choice;
}

}  // namespace a351::corrector::model
