// SPDX-License-Identifier: MIT
#include "program/control.hpp"

#include "closest.hpp"
#include "input_error.hpp"

namespace viewer {

Arguments read_arguments(std::span<const std::string> words, const std::vector<Control>& controls) {
    Arguments arguments;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        if (!word.starts_with("--")) {
            arguments.scene.push_back(word);
            continue;
        }
        const std::size_t equals = word.find('=');
        const std::string name = word.substr(0, equals);
        const Control* control = find_control(controls, name);
        if (control == nullptr) {
            std::vector<std::string> names;
            for (const Control& known : controls) names.push_back(known.option);
            throw support::InputError(name + " is no option of the viewer" +
                                      support::did_you_mean(name, names) + " (see --help)");
        }
        if (control->kind == Control::Kind::flag)
            arguments.set(name, "");
        else if (equals != std::string::npos)
            arguments.set(name, word.substr(equals + 1));
        else if (i + 1 < words.size())
            arguments.set(name, words[++i]);
        else
            throw support::InputError(name + " needs a value (see --help)");
    }
    return arguments;
}

Arguments effective(const Arguments& arguments, const std::vector<Control>& controls) {
    Arguments rest = arguments;
    for (const Control& control : controls) {
        if (!arguments.has(control.option)) continue;
        for (const std::string& replaced : control.replaces) rest.remove(replaced);
        const auto& [needed, text] = control.needs;
        if (!needed.empty() && arguments.get(needed) != text) rest.remove(control.option);
    }
    return rest;
}

}  // namespace viewer
