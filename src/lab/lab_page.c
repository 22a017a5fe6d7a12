/* lab_page.c - the HTML of a report; see lab_page.h.
 *
 * What is known is written as tables, which need no script, no colour and no pointer. The timeline
 * and the sliders come on top: lab.js draws them from the numbers that stand in the page as JSON.
 * All times are whole picoseconds, which JavaScript's numbers hold exactly up to 2^53 (2.5 hours).
 */
#include "lab/lab_page.h"

#include <string.h>

#include "base/beside.h"
#include "base/json.h"
#include "base/text.h"
#include "plan/plan.h"
#include "report/markup.h"
#include "report/page.h"

/* The durations on a path add up to the makespan without remainder (path.h), so that shares are
 * exact in picoseconds before they are printed as percentages. */
void lab_shares_of(const struct run_result *r, lab_shares out)
{
    memset(out, 0, sizeof(lab_shares));
    out[0] = r->makespan_ps;
    for (int64_t i = 0; i < r->npath; i++)
        out[1 + r->path[i].cause] += r->path[i].end_ps - r->path[i].begin_ps;
}

/* --- pieces of HTML --- */

/* A text of anybody between two of ours: the one way by which a name, a note or a program of a
 * student gets into the page. */
static void put(FILE *out, const char *before, const char *text, const char *after)
{
    fputs(before, out);
    markup_escape(out, text);
    fputs(after, out);
}

/* A whole number in groups of three, as people read picoseconds: 18 990 000. The blank is a narrow
 * one that does not break. */
static void put_number(FILE *out, int64_t x)
{
    char digits[24];
    snprintf(digits, sizeof digits, "%lld", (long long)x);
    const size_t n = strlen(digits), sign = digits[0] == '-';
    for (size_t i = 0; i < n; i++) {
        if (i > sign && (n - i) % 3 == 0) fputs("&#8239;", out);
        putc(digits[i], out);
    }
}

/* A number of a table; a dash where there is none, which is not 0. */
static void put_cell(FILE *out, bool known, int64_t x)
{
    fputs("<td class=\"number\">", out);
    if (known) put_number(out, x);
    else fputs("&ndash;", out);
    fputs("</td>", out);
}

/* The questions, as `lab check` has them. A verdict is a word, so that no colour is needed. */
static void put_answers(const struct lab_page *p, FILE *out)
{
    const struct lab_result *r = p->check;
    put(out, "<h2>Predictions</h2>\n<p>Program: ", r->program, ". ");
    fprintf(out, "<strong>%d of %d right.</strong></p>\n", r->right, r->nanswer);
    /* Heads of columns and rows are marked as such: a table is read out cell by cell. */
    fputs("<div class=\"wide\"><table>\n<thead><tr><th scope=\"col\">question</th>"
          "<th scope=\"col\">unit</th><th scope=\"col\">predicted</th>"
          "<th scope=\"col\">simulated</th><th scope=\"col\">verdict</th></tr></thead>\n<tbody>\n",
          out);
    for (int i = 0; i < r->nanswer; i++) {
        /* The question in the lesson's words, with the student's numbers in it. */
        const struct lab_answer *x = &r->answer[i];
        put(out, "<tr><th scope=\"row\">", p->lab->question[i].text, "</th>");
        put(out, "<td>", x->unit, "</td>");
        put_cell(out, x->given, x->predicted);
        put_cell(out, x->shown, x->simulated);
        put(out, "<td>", x->verdict, "</td></tr>\n");
    }
    fputs("</tbody></table></div>\n", out);
}

/* The critical path of each run by cause, as a table: the picture in words. */
static void put_paths(const struct lab_page *p, FILE *out)
{
    fputs("<h2>Critical paths</h2>\n<p>The critical path is the chain of operations that decides "
          "when "
          "the last rank ends: its parts add up to the time of the run.</p>\n"
          "<div class=\"wide\"><table>\n<thead><tr><th scope=\"col\">run</th>"
          "<th scope=\"col\">cause</th><th scope=\"col\">time [ps]</th>"
          "<th scope=\"col\">share</th></tr></thead>\n<tbody>\n",
          out);
    for (int i = 0; i < p->nrun; i++) {
        lab_shares share;
        lab_shares_of(p->run[i].result, share);
        for (int c = 0; c < PATH_CAUSES; c++) {
            /* What does not occur says nothing: gaps, barriers and servers are often absent. */
            if (share[1 + c] == 0) continue;
            put(out, "<tr><td>", p->run[i].title, "</td>");
            put(out, "<td>", path_cause_word((enum path_cause)c), "</td>");
            put_cell(out, true, share[1 + c]);
            fprintf(out, "<td class=\"number\">%.1f %%</td></tr>\n",
                    100.0 * (double)share[1 + c] / (double)share[0]);
        }
    }
    fputs("</tbody></table></div>\n", out);
}

/* The picture, its controls and its legend. Ranks, spans and steps of the path can be walked
 * through one by one, each told in a sentence, so that the picture need not be seen. Every control
 * is a button, and has a key, too. */
static void put_timeline(const struct lab_page *p, FILE *out)
{
    /* The words of data-do are those of `actions` in lab.js. */
    static const char *const button[][2] = {{"zoom-in", "Zoom in (+)"},
                                            {"zoom-out", "Zoom out (&minus;)"},
                                            {"earlier", "Earlier (&larr;)"},
                                            {"later", "Later (&rarr;)"},
                                            {"whole", "Whole run (Home)"},
                                            {"up", "Rank above (&uarr;)"},
                                            {"down", "Rank below (&darr;)"},
                                            {"span-last", "Last part of the rank (p)"},
                                            {"span-next", "Next part of the rank (n)"},
                                            {"step-last", "Last step of the path (C)"},
                                            {"step-next", "Next step of the path (c)"}};
    fputs(
        "<h2>Timeline</h2>\n<p id=\"help\">A row is a rank, from left to right is simulated time. "
        "The thick black line is the critical path; in dashes a message is on its way. "
        "The keys in brackets work while the picture has the focus (Tab); the wheel zooms, and "
        "dragging moves.</p>\n<div class=\"controls\"><label for=\"run\">Run </label>"
        "<select id=\"run\">\n",
        out);
    for (int i = 0; i < p->nrun; i++) {
        fprintf(out, "<option value=\"%d\">", i);
        put(out, "", p->run[i].title, "</option>\n");
    }
    fputs("</select><br>\n", out);
    for (size_t i = 0; i < sizeof button / sizeof *button; i++)
        fprintf(out, "<button type=\"button\" data-do=\"%s\">%s</button>\n", button[i][0],
                button[i][1]);
    /* Focusable, with a name and a help that are read out, and a live region for what was chosen.
     */
    fputs("</div>\n<svg class=\"timeline\" id=\"timeline\" tabindex=\"0\" role=\"application\" "
          "aria-label=\"Timeline of the run\" aria-describedby=\"help said\"></svg>\n"
          "<p class=\"said\" id=\"said\" role=\"status\" aria-live=\"polite\">"
          "The picture needs scripts; the tables have the same numbers.</p>\n"
          "<p>C computing (dark), S sending (strokes rising), R receiving (strokes falling), "
          "W waiting (dots), B barrier (grid).</p>\n",
          out);
}

/* A slider for each thing that may be changed, and what comes out: a time, its ratio to the
 * student's own, and a table of the critical path's causes, which is what a change of the machine
 * moves. The elements are those of the platform: a range, an output, a button, which every browser
 * can work by keyboard and reads out. */
static void put_sliders(const struct lab_page *p, FILE *out)
{
    /* A lesson about something else than times has none. */
    if (p->lab->nslider == 0) return;
    fputs("<h2>What if</h2>\n<p>Every place of the sliders is a run that was simulated; nothing is "
          "interpolated.</p>\n",
          out);
    for (int i = 0; i < p->lab->nslider; i++) {
        /* A range of whole numbers: its places. Which value is at one, lab.js says as a text. */
        const struct lab_slider *s = &p->lab->slider[i];
        fprintf(out, "<div class=\"slider\"><label for=\"slider-%d\">", i);
        put(out, "", s->text, "</label>");
        fprintf(out,
                "<input type=\"range\" id=\"slider-%d\" min=\"0\" max=\"%d\" step=\"1\" "
                "value=\"%d\"><output id=\"value-%d\" for=\"slider-%d\"></output></div>\n",
                i, s->nvalue - 1, s->own, i, i);
    }
    fputs(
        "<div class=\"controls\"><button type=\"button\" id=\"own\">Back to yours</button></div>\n"
        "<p class=\"result\" role=\"status\" aria-live=\"polite\">Time of the run: "
        "<strong id=\"result\"></strong></p>\n<table>\n<caption>Its critical path</caption>\n"
        "<thead><tr><th scope=\"col\">cause</th><th scope=\"col\">time</th>"
        "<th scope=\"col\">share</th><th scope=\"col\"></th></tr></thead>\n"
        "<tbody id=\"shares\"></tbody></table>\n",
        out);
}

/* --- the numbers, for lab.js --- */

/* One run: its spans and its path, each a short list. Lists of numbers and not objects: a page of
 * the largest lesson has 2,000 spans, and names of members would be most of it. */
static void json_run(const struct lab_page_run *run, struct json *j)
{
    const struct run_result *r = run->result;
    /* Browsers draw some ten thousand marks at once; a part of the run would be misread as all. */
    const bool all = r->nspan <= LAB_PAGE_SPANS;
    json_object(j);
    json_key_int(j, "ranks", r->nrank);
    json_key_int(j, "end", r->makespan_ps);
    json_key_int(j, "omitted", all ? 0 : r->nspan);
    json_key(j, "spans");
    json_array(j);
    for (int64_t i = 0; all && i < r->nspan; i++) {
        const struct span *s = &r->span[i];
        /* The order of the numbers is that of lab.js (RANK, KIND, ...). */
        const int64_t value[] = {s->rank, s->kind,  s->begin_ps, s->end_ps,
                                 s->peer, s->bytes, s->message};
        json_array(j);
        for (int k = 0; k < 7; k++) json_int(j, value[k]);
        json_end(j);
    }
    json_end(j);
    json_key(j, "path");
    json_array(j);
    for (int64_t i = 0; i < r->npath; i++) {
        const struct path_step *s = &r->path[i];
        const int64_t value[] = {s->begin_ps, s->end_ps, s->cause, s->rank};
        /* Steps without duration, such as the start, would be steps of the reader for nothing. */
        if (s->end_ps == s->begin_ps) continue;
        json_array(j);
        for (int k = 0; k < 4; k++) json_int(j, value[k]);
        json_end(j);
    }
    json_end(j);
    json_end(j);
}

/* What each place of the sliders takes; null: it cannot run. All causes stand there, also those
 * that are 0: lab.js finds them by their number. */
static void json_grid(const struct lab_page *p, struct json *j)
{
    const int npoint = lab_points(p->lab);
    json_array(j);
    for (int i = 0; i < p->nrun; i++) {
        json_array(j);
        for (int g = 0; g < npoint; g++) {
            const int64_t *x = p->run[i].point[g];
            if (x[0] == 0) {
                json_null(j);
                continue;
            }
            json_array(j);
            for (int k = 0; k < 1 + PATH_CAUSES; k++) json_int(j, x[k]);
            json_end(j);
        }
        json_end(j);
    }
    json_end(j);
}

/* The texts of the sliders' places, and which of them are the student's own. */
static void json_sliders(const struct lab *l, struct json *j)
{
    json_array(j);
    for (int i = 0; i < l->nslider; i++) {
        json_object(j);
        json_key_int(j, "own", l->slider[i].own);
        json_key(j, "values");
        json_array(j);
        for (int k = 0; k < l->slider[i].nvalue; k++) json_text(j, l->slider[i].value[k]);
        json_end(j);
        json_end(j);
    }
    json_end(j);
}

/* The JSON inside its element. A text of a student could end that element: every "<" is written as
 * JSON's own escape, which the reader turns back. */
static void put_data(const struct lab_page *p, FILE *out)
{
    /* During these the rank itself is busy; everything else on the path happens in the network. */
    static const enum path_cause busy[] = {PATH_START, PATH_COMPUTE, PATH_SEND, PATH_RECV,
                                           PATH_POLL};
    struct text t = {0};
    FILE *stream = text_stream(&t);
    struct json j = json_make(stream);
    json_object(&j);
    json_key(&j, "causes");
    json_array(&j);
    for (int c = 0; c < PATH_CAUSES; c++) json_text(&j, path_cause_word((enum path_cause)c));
    json_end(&j);
    json_key(&j, "busy");
    json_array(&j);
    for (size_t i = 0; i < sizeof busy / sizeof *busy; i++) json_int(&j, (int64_t)busy[i]);
    json_end(&j);
    json_key(&j, "runs");
    json_array(&j);
    for (int i = 0; i < p->nrun; i++) json_run(&p->run[i], &j);
    json_end(&j);
    json_key(&j, "sliders");
    json_sliders(p->lab, &j);
    json_key(&j, "grid");
    json_grid(p, &j);
    json_end(&j);
    json_finish(&j);
    text_stream_end(stream);
    fputs("<script type=\"application/json\" id=\"data\">", out);
    for (const char *s = t.s; *s; s++) {
        if (*s == '<') fputs("\\u003c", out);
        else putc(*s, out);
    }
    fputs("</script>\n", out);
    text_free(&t);
}

/* --- the page --- */

/* A file of plots/, appended: the page holds what it needs, as it will be opened elsewhere. */
static bool read_part(const char *name, struct text *t, struct err *e)
{
    struct text path = {0}, part = {0};
    text_add(&path, "%s/plots/%s", plan_data_dir(), name);
    const bool ok = text_read_file(&part, path.s, e);
    if (ok) text_add_bytes(t, part.s, part.length);
    text_free(&path);
    text_free(&part);
    return ok;
}

/* The order is that of a reader: what was asked, what happened, what could be, and the program. */
static void put_page(const struct lab_page *p, const struct text *style, const struct text *script,
                     FILE *out)
{
    /* The policy in the head names the one script by its fingerprint: if a text of a student were
     * markup in spite of all, the browser would not run it. */
    page_head(out, style, script);
    put(out, "<title>", p->lab->title, p->lab->student[0] ? ", " : "");
    put(out, "", p->lab->student, "</title>\n</head>\n<body>\n<main>\n");
    put(out, "<h1>", p->lab->title, "</h1>\n");
    put(out, "<p>Lesson ", p->lab->name, p->lab->student[0] ? ", variant of " : "");
    put(out, "<strong>", p->lab->student, "</strong>. ");
    put(out, "", p->lab->goal, "</p>\n");
    put_answers(p, out);
    /* Of a program that does not end well there is nothing to explore: the verdicts say why. */
    if (p->nrun > 0) {
        put_timeline(p, out);
        put_sliders(p, out);
        put_paths(p, out);
    }
    if (p->notes != NULL)
        put(out, "<h2>Answers to the questions</h2>\n<div class=\"notes\">", p->notes, "</div>\n");
    put(out, "<h2>Program</h2>\n<details open><summary>", p->lab->program, "</summary>\n<pre>");
    put(out, "", p->source, "</pre></details>\n</main>\n");
    /* Numbers and script at the end, so that a reader sees the page before they are read. */
    if (p->nrun > 0) {
        put_data(p, out);
        fprintf(out, "<script>%s</script>\n", script->s);
    }
    fputs("</body>\n</html>\n", out);
}

bool lab_page_write(const struct lab_page *p, const char *path, struct err *e)
{
    struct text style = {0}, script = {0}, page = {0};
    /* The look is that of all reports of this program, and what the timeline needs besides. */
    bool ok = read_part("report.css", &style, e) && read_part("lab.css", &style, e) &&
              read_part("lab.js", &script, e);
    if (ok) {
        FILE *out = text_stream(&page);
        put_page(p, &style, &script, out);
        text_stream_end(out);
        /* Whole or not at all: a report of before stays until this one is complete. */
        ok = beside_write(path, page.s, page.length, e);
    }
    text_free(&style);
    text_free(&script);
    text_free(&page);
    return ok;
}
