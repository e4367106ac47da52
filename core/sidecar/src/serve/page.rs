//! The page of the protocol, from the table of methods.

use super::methods::METHODS;
use serde_json::Value;
use std::fmt::Write;

const INTRODUCTION: &str = r#"# The protocol

This page is printed by `coolinggen serve --describe`; a test keeps it so.

`coolinggen serve` speaks JSON-RPC 2.0 over standard input and output, one message a line (UTF-8, no line breaks inside).
Standard output carries the protocol alone, logs go to standard error. With `--socket NAME` it listens on a local socket,
too: `NAME` is a path, or a bare name that the server puts into a folder of the user's and prints on standard error.
All clients share the models, so that two programs can show one.

    > {"jsonrpc":"2.0","id":1,"method":"initialize","params":{"protocol_version":1}}
    < {"jsonrpc":"2.0","id":1,"result":{"protocol_version":1,...}}
    > {"jsonrpc":"2.0","id":2,"method":"design/generate","params":{"model":"a","design":{...}}}
    < {"jsonrpc":"2.0","method":"$/progress","params":{"id":2,"stage":"build","fraction":0.2}}
    < {"jsonrpc":"2.0","id":2,"result":{"model":"a","report":{...}}}

- Ids are strings or numbers; one may be used again when its reply has come. Batches are not served. A message has at
  most 64 MiB.
- Requests run side by side, but generations of one model one after the other. Replies come in the order in which they
  are ready.
- `$/progress` comes at most ten times a second for a request: `id`, `stage` (`blade`, `build`, `measure`, `tessellate`,
  `export`) and `fraction` of the whole.
- `$/cancelRequest` with the `id` of a request asks it to stop; its reply is then error -32800, within a tenth of a second,
  unless it was ready before.
- `shutdown` is replied to and ends the server. So does the end of standard input, even while requests run, and the death
  of the parent process; with `--detached` standard input is left alone. Files are complete or not there at all.

## Errors

| code | meaning | `data` |
|---|---|---|
| -32700 | the line is no JSON | |
| -32600 | the message is no request, too long, or its id is in use | |
| -32601 | there is no such method | |
| -32602 | parameters or design refused: all faults at once | list of `{pointer, code, value, min, max, unit, message, hint}`, pointers relative to `params` |
| -32603 | a defect of coolinggen | |
| -32001 | the file system refused | `{path}` |
| -32002 | `initialize` was not the first request | |
| -32800 | cancelled | |

## Methods
"#;

/// The whole page, Markdown.
pub(super) fn page() -> String {
    let mut text = INTRODUCTION.to_owned();
    for method in METHODS {
        let _ = write!(text, "\n### `{}`\n\n{}\n\n", method.name, method.summary);
        let schema = (method.params)();
        let properties = schema["properties"].as_object().cloned().unwrap_or_default();
        if !properties.is_empty() {
            text.push_str("| parameter | | meaning |\n|---|---|---|\n");
            for (name, property) in &properties {
                let required =
                    schema["required"].as_array().is_some_and(|r| r.contains(&Value::from(name.as_str())));
                let meaning = property["description"].as_str().unwrap_or_default().replace('\n', " ");
                let needed = match property.get("default").filter(|d| !d.is_null()) {
                    _ if required => "required".to_owned(),
                    Some(default) => format!("default `{default}`"),
                    None => "optional".to_owned(),
                };
                let _ = writeln!(text, "| `{name}` | {needed} | {meaning} |");
            }
            text.push('\n');
        }
        let _ = writeln!(text, "Result: {}.", method.result);
    }
    text
}
