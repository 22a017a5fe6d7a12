/* opening.c - abstract and glossary of the report on the paper; see opening.h. */
#include "report/opening.h"

#include "base/text.h"

/* The query data_dir/plots/NAME.sql. */
static bool read_query(const char *data_dir, const char *name, struct text *sql, struct err *e)
{
    struct text path = {0};
    text_add(&path, "%s/plots/%s.sql", data_dir, name);
    bool ok = text_read_file(sql, path.s, e);
    text_add(sql, "%s", "");
    text_free(&path);
    return ok;
}

static bool tell_paragraph(void *context, int ncolumn, const char *const *name,
                           const char *const *value)
{
    (void)ncolumn;
    (void)name;
    page_paragraph(context, value[0] ? value[0] : "");
    return true;
}

static bool put_table(struct page *p, struct store *s, const char *data_dir, const char *name,
                      struct err *e)
{
    struct text sql = {0};
    bool ok =
        read_query(data_dir, name, &sql, e) && page_table(p, s, sql.s, 0, NULL, "Nothing.", e);
    text_free(&sql);
    return ok;
}

bool opening_abstract(struct page *p, struct store *s, const char *data_dir, struct err *e)
{
    struct text sql = {0};
    page_heading(p, 2, "Abstract");
    bool ok = read_query(data_dir, "abstract", &sql, e) &&
              store_select(s, sql.s, 0, NULL, tell_paragraph, p, e);
    text_free(&sql);
    return ok && put_table(p, s, data_dir, "verdicts", e);
}

bool opening_glossary(struct page *p, struct store *s, const char *data_dir, struct err *e)
{
    page_heading(p, 2, "Glossary");
    return put_table(p, s, data_dir, "glossary", e);
}
