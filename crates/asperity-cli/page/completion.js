// What may stand at a place of a case, from its JSON Schema.

let schema;

/** All forms that a part of the schema may have. */
function forms(node, depth = 0) {
  if (!node || depth > 8) return [];
  if (node.$ref) return forms({ ...node, ...schema.$defs[node.$ref.split("/").pop()], $ref: undefined, description: node.description ?? schema.$defs[node.$ref.split("/").pop()].description }, depth + 1);
  const more = [...(node.oneOf ?? []), ...(node.anyOf ?? []), ...(node.allOf ?? [])];
  return more.length ? more.flatMap((one) => forms(one, depth + 1)).concat(node.properties ? [node] : []) : [node];
}

/** Steps of "body[0].material": names; the element of a list has the form of its items. */
const steps = (key) => key.replace(/\[\d+\]/g, "").split(".").filter(Boolean);

/** The forms of a key; `values` are those of the case, which say by `kind` or `model` which form a table has. */
function formsOf(key, values) {
  let path = "", found = [schema];
  for (const part of key.split(".").filter(Boolean)) {
    found = tablesOf(found, path, values).flatMap((form) => forms(form.properties?.[part.replace(/\[\d+\]/, "")]));
    path = path ? `${path}.${part}` : part;
  }
  return found;
}

/** The tables among forms, of those with a tag the one that the case has. */
function tablesOf(found, path, values) {
  const tables = found.flatMap((form) => (form.type === "array" ? forms(form.items) : [form])).filter((form) => form.properties);
  const fits = (form) => Object.entries(form.properties).every(([name, one]) => one.const === undefined || values[`${path}.${name}`] === undefined || values[`${path}.${name}`] === one.const);
  const fitting = tables.filter(fits);
  return fitting.length ? fitting : tables;
}

/** Keys of a table: name, description, form. */
function keysOf(path, values) {
  const found = new Map();
  for (const table of tablesOf(path ? formsOf(path, values) : [schema], path, values)) {
    for (const [name, form] of Object.entries(table.properties)) if (!found.has(name)) found.set(name, form);
  }
  return found;
}

/** What the schema says of a key. */
function descriptionOf(key, values) {
  const at = key.lastIndexOf("."), form = keysOf(key.slice(0, Math.max(at, 0)), values).get(key.slice(at + 1).replace(/\[\d+\]/g, ""));
  return form?.description ?? "";
}

/** The words that a key may have as its value; null where it is no choice. */
function wordsOf(key, values) {
  const path = key.split(".").slice(0, -1).join("."), name = steps(key).pop();
  const tables = path ? formsOf(path, {}).flatMap((form) => (form.type === "array" ? forms(form.items) : [form])) : [schema];
  const all = tables.flatMap((table) => forms(table.properties?.[name]));
  const list = all.flatMap((form) => (form.type === "array" ? forms(form.items) : [form])).flatMap((form) => form.enum ?? (form.const !== undefined ? [form.const] : []));
  if (all.some((form) => form.type === "boolean")) list.push("true", "false");
  return list.length ? { list: [...new Set(list)], many: all.some((form) => form.type === "array"), free: all.some((form) => !form.enum && form.const === undefined) } : null;
}

/** The table and the key at a place of the text: the last header, and the inline tables that are open in the line. */
function placeAt(text) {
  const lines = text.split("\n"), line = lines.pop(), counts = {};
  let path = "";
  for (const one of lines) {
    const header = /^\s*(\[\[?)\s*([\w.-]+)\s*\]\]?/.exec(one);
    if (!header) continue;
    const parent = header[2].split(".").slice(0, -1).join(".");
    const above = parent && parent in counts ? `${parent}[${counts[parent]}]` : parent;
    const full = [above, header[2].split(".").pop()].filter(Boolean).join(".");
    if (header[1] === "[[") counts[header[2]] = (counts[header[2]] ?? -1) + 1;
    path = header[1] === "[[" ? `${full}[${counts[header[2]]}]` : full;
  }
  if (/^\s*\[/.test(line)) return { header: true };
  // Words in quotes hide signs.
  let key = "", open = [], word = "", quote = false;
  for (const sign of line) {
    if (quote) { if (sign === '"') quote = false; word += sign; continue; }
    if (sign === '"') { quote = true; word += sign; } else if (sign === "#") return null;
    else if (sign === "=") { key = word.trim(); word = ""; }
    else if (sign === "{") { open.push(key); key = word = ""; }
    else if (sign === "}") { open.pop(); key = word = ""; }
    else if (sign === "," && !word.includes("[")) { key = word = ""; } else word += sign;
  }
  const table = [path, ...open].filter(Boolean).join(".");
  return key ? { key: [table, key].filter(Boolean).join("."), word, quote } : { table, word: word.trim() };
}

/** What the editor offers. */
function completions(values) {
  return (context) => {
    const place = placeAt(context.state.sliceDoc(0, context.pos));
    const before = context.matchBefore(/[\w-]*/);
    if (!place || (!context.explicit && before.from === before.to && !place.quote)) return null;
    const option = (label, form, apply, type) => ({ label, apply, type, info: form?.description ? () => make("div", {}, form.description) : undefined, detail: form?.examples ? JSON.stringify(form.examples[0]) : "" });
    if (place.header) {
      const tables = [...keysOf("", values())].filter(([, form]) => forms(form).some((one) => one.properties || one.type === "array"));
      return { from: before.from, options: tables.map(([name, form]) => option(name, form, name, "namespace")) };
    }
    if (place.key) {
      const choice = wordsOf(place.key, values());
      if (!choice) return null;
      return { from: before.from, options: choice.list.map((word) => option(String(word), null, place.quote || /^(true|false)$/.test(word) ? String(word) : `"${word}"`, "enum")) };
    }
    return { from: before.from, options: [...keysOf(place.table, values())].map(([name, form]) => option(name, form, `${name} = `, "property")) };
  };
}
