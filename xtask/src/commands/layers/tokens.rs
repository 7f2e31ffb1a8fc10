//! What a source file says of modules: read from its tokens, so that the bodies of macros count too.

use std::collections::BTreeSet;

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use syn::UseTree;

/// What one module declares, imports and mentions; code behind `#[cfg(test)]` is left out.
#[derive(Default)]
pub struct Content {
    /// Modules in files of their own.
    pub files: Vec<String>,
    /// Modules written in place.
    pub inline: Vec<(String, Content)>,
    /// Functions, types, constants, traits, macros.
    pub items: BTreeSet<String>,
    pub imports: Vec<Import>,
    /// Paths outside of imports; those of one segment are names that may have been imported.
    pub paths: BTreeSet<Vec<String>>,
}

/// One name, or all of a module, taken by a `use`.
pub struct Import {
    /// What it is called here; `None`: everything in it.
    pub name: Option<String>,
    pub path: Vec<String>,
    /// Others may take it from here.
    pub public: bool,
}

/// Reads the tokens of a module.
pub fn content(tokens: TokenStream) -> syn::Result<Content> {
    let mut content = Content::default();
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut public = false;
    let mut at = 0;
    while at < tokens.len() {
        if test_only(&tokens[at..]) {
            at += end_of_item(&tokens[at..]);
            continue;
        }
        let word = ident(&tokens[at]).unwrap_or_default();
        let next = tokens.get(at + 1).and_then(ident);
        match (word.as_str(), next) {
            // `use<'a>` in a bound is no import.
            ("use", _) if imports(&tokens[at..]) => {
                let length = end_of_item(&tokens[at..]);
                content.import(&tree(&tokens[at..at + length])?, &[], public);
                at += length;
            }
            ("mod", Some(name)) => {
                match tokens.get(at + 2) {
                    Some(TokenTree::Group(body)) => {
                        let inner = self::content(body.stream())?;
                        content.inline.push((name, inner));
                    }
                    _ => content.files.push(name),
                }
                at += 3;
            }
            // `&'static super::Kind` declares nothing.
            (keyword, Some(name))
                if declares(keyword) && !declares(&name) && !is_lifetime(&tokens, at) =>
            {
                content.items.insert(name);
                at += 2;
            }
            ("macro_rules", _) => {
                content.items.extend(tokens.get(at + 2).and_then(ident));
                at += 3;
            }
            ("pub", _) => at += 1,
            _ => at += mention(&tokens, at, &mut content.paths),
        }
        public = word == "pub" || public && tokens.get(at - 1).is_some_and(in_parentheses);
    }
    Ok(content)
}

impl Content {
    fn import(&mut self, tree: &UseTree, before: &[String], public: bool) {
        let with = |name: String| [before, &[name]].concat();
        let (name, path) = match tree {
            UseTree::Path(path) => {
                return self.import(&path.tree, &with(path.ident.to_string()), public);
            }
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.import(tree, before, public);
                }
                return;
            }
            UseTree::Glob(_) => (None, before.to_vec()),
            UseTree::Rename(rename) => (
                Some(rename.rename.to_string()),
                with(rename.ident.to_string()),
            ),
            UseTree::Name(name) if name.ident == "self" => {
                (before.last().cloned(), before.to_vec())
            }
            UseTree::Name(name) => (Some(name.ident.to_string()), with(name.ident.to_string())),
        };
        self.imports.push(Import { name, path, public });
    }
}

/// Adds the path that begins at a token, and all inside a group; returns how many tokens that were.
fn mention(tokens: &[TokenTree], at: usize, paths: &mut BTreeSet<Vec<String>>) -> usize {
    match &tokens[at] {
        TokenTree::Group(group) => {
            let inside: Vec<TokenTree> = group.stream().into_iter().collect();
            let mut place = 0;
            while place < inside.len() {
                place += if test_only(&inside[place..]) {
                    end_of_item(&inside[place..])
                } else {
                    mention(&inside, place, paths)
                };
            }
            1
        }
        // Inside a function, where it may be in braces: all that it names.
        TokenTree::Ident(word) if word == "use" && imports(&tokens[at..]) => {
            let length = end_of_item(&tokens[at..]);
            let mut own = Content::default();
            if let Ok(tree) = tree(&tokens[at..at + length]) {
                own.import(&tree, &[], false);
            }
            paths.extend(own.imports.into_iter().map(|import| import.path));
            length
        }
        TokenTree::Ident(first) => {
            let mut path = vec![first.to_string()];
            let mut end = at + 1;
            while colons(&tokens[end..])
                && let Some(name) = tokens.get(end + 2).and_then(ident)
            {
                path.push(name);
                end += 3;
            }
            if path.len() > 1 || may_be_imported(tokens, at) {
                paths.insert(path);
            }
            end - at
        }
        _ => 1,
    }
}

/// A name by itself: a type or constant, or a function or macro that is called; no field, method or variable.
fn may_be_imported(tokens: &[TokenTree], at: usize) -> bool {
    let after_dot = at > 0
        && punct(&tokens[at - 1]) == Some('.')
        && !(at > 1 && punct(&tokens[at - 2]) == Some('.'));
    let upper = ident(&tokens[at]).is_some_and(|name| name.starts_with(char::is_uppercase));
    let called = tokens
        .get(at + 1)
        .is_some_and(|next| in_parentheses(next) || punct(next) == Some('!'));
    !after_dot && (upper || called)
}

fn test_only(tokens: &[TokenTree]) -> bool {
    let [hash, TokenTree::Group(attribute), ..] = tokens else {
        return false;
    };
    punct(hash) == Some('#') && attribute.stream().to_string().replace(' ', "") == "cfg(test)"
}

/// Whether an import begins here; `use<'a>` in a bound is none.
fn imports(tokens: &[TokenTree]) -> bool {
    let [word, next, ..] = tokens else {
        return false;
    };
    ident(word).is_some_and(|word| word == "use") && punct(next) != Some('<')
}

/// What an import names, from `use` to its semicolon.
fn tree(tokens: &[TokenTree]) -> syn::Result<UseTree> {
    let named = tokens.iter().skip(1).take(tokens.len().saturating_sub(2));
    syn::parse2(named.cloned().collect())
}

/// How many tokens up to the end of the item that begins here: a semicolon, or the braces of a body.
fn end_of_item(tokens: &[TokenTree]) -> usize {
    let is_import = imports(tokens);
    let ends = |token: &TokenTree| match token {
        TokenTree::Group(group) => !is_import && group.delimiter() == Delimiter::Brace,
        token => punct(token) == Some(';'),
    };
    let end = tokens.iter().position(ends);
    end.map_or(tokens.len(), |end| end + 1)
}

/// Whether the word at this place names a lifetime.
fn is_lifetime(tokens: &[TokenTree], at: usize) -> bool {
    let before = at.checked_sub(1).and_then(|before| tokens.get(before));
    before.is_some_and(|token| punct(token) == Some('\''))
}

fn declares(word: &str) -> bool {
    let keywords = [
        "fn", "struct", "enum", "trait", "const", "static", "type", "union", "unsafe", "extern",
        "async", "mut",
    ];
    keywords.contains(&word)
}

fn ident(token: &TokenTree) -> Option<String> {
    match token {
        TokenTree::Ident(ident) => Some(ident.to_string().trim_start_matches("r#").to_owned()),
        _ => None,
    }
}

fn punct(token: &TokenTree) -> Option<char> {
    match token {
        TokenTree::Punct(punct) => Some(punct.as_char()),
        _ => None,
    }
}

fn colons(tokens: &[TokenTree]) -> bool {
    matches!(tokens, [a, b, ..] if punct(a) == Some(':') && punct(b) == Some(':'))
}

fn in_parentheses(token: &TokenTree) -> bool {
    matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Parenthesis)
}
