//! What macros of a file make in the same file, written out: every copy then has mutants of its own.
//!
//! For macros of one rule whose text is items, and whose fragments are single; attributes that repeat are dropped.

use proc_macro2::{Group, TokenStream, TokenTree};
use quote::{ToTokens, quote};
use std::collections::HashMap;
use syn::parse::{ParseStream, Parser};
use syn::{Expr, Item, Lit};

type Fragments = HashMap<String, TokenStream>;

struct Rule {
    pattern: TokenStream,
    body: TokenStream,
}

fn rule(tokens: &TokenStream) -> Option<Rule> {
    let trees: Vec<TokenTree> = tokens.clone().into_iter().collect();
    match trees.as_slice() {
        [TokenTree::Group(pattern), TokenTree::Punct(_), TokenTree::Punct(_), TokenTree::Group(body), end @ ..]
            if end.len() < 2 =>
        {
            Some(Rule { pattern: pattern.stream(), body: body.stream() })
        }
        _ => None,
    }
}

fn is(tree: Option<&TokenTree>, mark: char) -> bool {
    matches!(tree, Some(TokenTree::Punct(punct)) if punct.as_char() == mark)
}

/// A fragment of this kind.
fn fragment(input: ParseStream, kind: &str) -> syn::Result<TokenStream> {
    Ok(match kind {
        "ident" => input.parse::<syn::Ident>()?.to_token_stream(),
        "literal" => input.parse::<Lit>()?.to_token_stream(),
        "path" => input.parse::<syn::Path>()?.to_token_stream(),
        // One operand, as in the macro.
        "expr" => {
            let expr: Expr = input.parse()?;
            quote!((#expr))
        }
        _ => return Err(input.error(format!("a fragment of the kind {kind}"))),
    })
}

fn read(input: ParseStream, pattern: TokenStream, found: &mut Fragments) -> syn::Result<()> {
    let mut pattern = pattern.into_iter().peekable();
    while let Some(tree) = pattern.next() {
        if is(Some(&tree), '$') {
            match pattern.next() {
                Some(TokenTree::Ident(name)) => {
                    let kind = pattern.nth(1).map(|kind| kind.to_string()).unwrap_or_default();
                    found.insert(name.to_string(), fragment(input, &kind)?);
                }
                // Attributes, any number.
                _ => {
                    pattern.next();
                    input.call(syn::Attribute::parse_outer)?;
                }
            }
            continue;
        }
        let own: TokenTree = input.parse()?;
        if let (TokenTree::Group(inner), TokenTree::Group(own)) = (&tree, &own) {
            (|input: ParseStream| read(input, inner.stream(), found)).parse2(own.stream())?;
        } else if tree.to_string() != own.to_string() {
            return Err(input.error(format!("{tree} expected")));
        }
    }
    Ok(())
}

fn write(body: TokenStream, fragments: &Fragments) -> TokenStream {
    let mut written = TokenStream::new();
    let mut body = body.into_iter().peekable();
    while let Some(tree) = body.next() {
        match tree {
            TokenTree::Punct(ref punct) if punct.as_char() == '$' => match body.next() {
                Some(TokenTree::Ident(name)) => written.extend(fragments[&name.to_string()].clone()),
                // Attributes.
                _ => drop(body.next()),
            },
            TokenTree::Group(group) => {
                let mut inner = Group::new(group.delimiter(), write(group.stream(), fragments));
                inner.set_span(group.span());
                written.extend([TokenTree::Group(inner)]);
            }
            other => written.extend([other]),
        }
    }
    written
}

/// Writes out what the file's own macros make.
pub fn expand(file: &mut syn::File) {
    let of = |item: &Item| match item {
        Item::Macro(item) => Some((item.ident.as_ref()?.to_string(), rule(&item.mac.tokens)?)),
        _ => None,
    };
    let rules: HashMap<String, Rule> = file.items.iter().filter_map(of).collect();
    let items = std::mem::take(&mut file.items);
    for item in items {
        let rule = match &item {
            Item::Macro(item) if item.ident.is_none() => rules.get(&item.mac.path.to_token_stream().to_string()),
            _ => None,
        };
        match (item, rule) {
            (Item::Macro(item), Some(rule)) => {
                let mut fragments = Fragments::new();
                let read = |input: ParseStream| read(input, rule.pattern.clone(), &mut fragments);
                read.parse2(item.mac.tokens).expect("what the macro asks for");
                let made: syn::File = syn::parse2(write(rule.body.clone(), &fragments)).expect("items");
                file.items.extend(made.items);
            }
            (item, _) => file.items.push(item),
        }
    }
    // Nobody uses them any more.
    file.items.retain(|item| !of(item).is_some_and(|(name, _)| rules.contains_key(&name)));
}
