//! JSON-RPC 2.0: requests, replies, errors.

use coolinggen_blade::Fault;
use serde_json::{Value, json};

/// A message from a client.
#[derive(Debug, PartialEq)]
pub(super) struct Call {
    /// The request's id; none for a notification, which has no reply.
    pub(super) id: Option<Value>,
    pub(super) method: String,
    pub(super) params: Value,
}

/// An error reply.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RpcError {
    pub(super) code: i64,
    pub(super) message: String,
    pub(super) data: Option<Value>,
}

impl RpcError {
    fn new(code: i64, message: impl Into<String>) -> Self {
        Self { code, message: message.into(), data: None }
    }

    /// The line is no JSON.
    pub(super) fn parse(message: impl Into<String>) -> Self {
        Self::new(-32700, message)
    }

    /// The message is no request.
    pub(super) fn invalid_request(message: impl Into<String>) -> Self {
        Self::new(-32600, message)
    }

    /// There is no such method.
    pub(super) fn unknown_method(method: &str, hint: &str) -> Self {
        Self::new(-32601, format!("there is no method {method}{hint}"))
    }

    /// The parameters, or the design in them, are refused: all faults at once.
    pub(super) fn invalid_params(faults: &[Fault]) -> Self {
        let first = faults.first().map(ToString::to_string).unwrap_or_default();
        let more = match faults.len() {
            0 | 1 => String::new(),
            n => format!(" (and {} more)", n - 1),
        };
        Self { code: -32602, message: format!("{first}{more}"), data: Some(json!(faults)) }
    }

    /// A defect of the server.
    pub(super) fn internal(message: impl Into<String>) -> Self {
        Self::new(-32603, message)
    }

    /// The file system refused.
    pub(super) fn file(what: &str, path: &std::path::Path, error: impl std::fmt::Display) -> Self {
        let message = format!("cannot {what} {}: {error}", path.display());
        Self { data: Some(json!({ "path": path })), ..Self::new(-32001, message) }
    }

    /// `initialize` was not the first request.
    pub(super) fn not_initialized() -> Self {
        Self::new(-32002, "the first request must be initialize")
    }

    /// The client cancelled the request.
    pub(super) fn cancelled() -> Self {
        Self::new(-32800, "the request was cancelled")
    }
}

/// Reads a message; a broken one gives the error and the id to reply with.
pub(super) fn read(line: &[u8]) -> Result<Call, (Value, RpcError)> {
    let message: Value = serde_json::from_slice(line)
        .map_err(|e| (Value::Null, RpcError::parse(format!("the line is no JSON: {e}"))))?;
    let Value::Object(mut members) = message else {
        let what = if message.is_array() { "batches are not served" } else { "a request is an object" };
        return Err((Value::Null, RpcError::invalid_request(what)));
    };
    let id = members.remove("id");
    let known = id.clone().filter(|id| id.is_string() || id.is_number());
    let answer_to = known.clone().unwrap_or(Value::Null);
    if id.is_some() && known.is_none() {
        return Err((answer_to, RpcError::invalid_request("id must be a string or a number")));
    }
    if members.remove("jsonrpc") != Some(json!("2.0")) {
        return Err((answer_to, RpcError::invalid_request("jsonrpc must be \"2.0\"")));
    }
    let Some(Value::String(method)) = members.remove("method") else {
        return Err((answer_to, RpcError::invalid_request("method must be a string")));
    };
    let params = members.remove("params").unwrap_or_else(|| json!({}));
    if !params.is_object() {
        return Err((answer_to, RpcError::invalid_request("params must be an object")));
    }
    Ok(Call { id: known, method, params })
}

/// The reply to request `id`.
pub(super) fn reply(id: &Value, result: Result<Value, RpcError>) -> Value {
    match result {
        Ok(result) => json!({ "jsonrpc": "2.0", "id": id, "result": result }),
        Err(RpcError { code, message, data }) => {
            let mut error = json!({ "code": code, "message": message });
            if let Some(data) = data {
                error["data"] = data;
            }
            json!({ "jsonrpc": "2.0", "id": id, "error": error })
        }
    }
}

/// A notification to the client.
pub(super) fn notification(method: &str, params: &Value) -> Value {
    json!({ "jsonrpc": "2.0", "method": method, "params": params })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broken_messages_keep_the_id_they_have() {
        for (line, id, code) in [
            ("{", json!(null), -32700),
            ("[]", json!(null), -32600),
            ("7", json!(null), -32600),
            (r#"{"id": 3}"#, json!(3), -32600),
            (r#"{"jsonrpc": "2.0", "id": "a", "method": 4}"#, json!("a"), -32600),
            (r#"{"jsonrpc": "2.0", "id": null, "method": "x"}"#, json!(null), -32600),
            (r#"{"jsonrpc": "2.0", "id": 1, "method": "x", "params": [1]}"#, json!(1), -32600),
        ] {
            let (found, error) = read(line.as_bytes()).unwrap_err();
            assert_eq!((found, error.code), (id, code), "{line}");
        }
        let call = read(br#"{"jsonrpc": "2.0", "method": "x"}"#).unwrap();
        assert_eq!(call, Call { id: None, method: "x".into(), params: json!({}) });
    }
}
