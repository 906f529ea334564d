// SPDX-License-Identifier: MIT
//
// Finds words in the text of the site's pages. site.py writes `search_sections`, a list of [address, title, text], one for each heading
// of each page. lunr (Debian's libjs-lunr) makes an index of them when a word is first looked for.
"use strict";

var search_index = null;

/** The sections that have all of the words, or words that begin with them: [address, title, text], the best first. */
function find_sections(words) {
    if (search_index === null) {
        search_index = lunr(function () {
            this.pipeline.remove(lunr.stopWordFilter);  // what is asked may be such a word
            this.ref("id");
            this.field("title", { boost: 4 });
            this.field("text");
            for (var i = 0; i < search_sections.length; ++i) {
                this.add({ id: i, title: search_sections[i][1], text: search_sections[i][2] });
            }
        });
    }
    var terms = words.toLowerCase().split(/[^a-z0-9_]+/).filter(function (word) { return word !== ""; });
    var left = null;
    terms.forEach(function (term) {  // a section has to have each of them
        var found = {};
        search_index.query(function (query) {
            query.term(term, { boost: 10 });
            query.term(term, { wildcard: lunr.Query.wildcard.TRAILING, usePipeline: false });
        }).forEach(function (hit) {
            if (left === null || hit.ref in left) found[hit.ref] = hit.score + (left === null ? 0 : left[hit.ref]);
        });
        left = found;
    });
    return Object.keys(left || {}).sort(function (a, b) { return left[b] - left[a] || a - b; }).map(function (id) { return search_sections[id]; });
}

/** Some words around the first place of a term. */
function words_around(text, words) {
    var first = words.toLowerCase().split(/[^a-z0-9_]+/).filter(Boolean)[0] || "";
    var at = Math.max(text.toLowerCase().indexOf(first), 0), from = text.lastIndexOf(" ", Math.max(at - 60, 0)) + 1;
    return (from > 0 ? "... " : "") + text.substring(from, at + 120) + (at + 120 < text.length ? " ..." : "");
}

/** The field and the list of the page `search_text`. */
function show_search() {
    var field = document.getElementById("search_words"), list = document.getElementById("search_found");
    function look() {
        list.textContent = "";
        var found = find_sections(field.value);
        found.slice(0, 50).forEach(function (section) {
            var item = document.createElement("li"), link = document.createElement("a"), around = document.createElement("p");
            link.href = section[0];
            link.textContent = section[1];
            around.textContent = words_around(section[2], field.value);
            item.appendChild(link);
            item.appendChild(around);
            list.appendChild(item);
        });
        document.getElementById("search_count").textContent =
            field.value.trim() === "" ? "" : found.length + (found.length === 1 ? " section" : " sections");
    }
    field.addEventListener("input", look);
    field.focus();
}
